"use strict";
// Sort a table by the column whose heading is clicked: the better end first, then the other way round.
for (const head of document.querySelectorAll("table.results thead th")) {
  head.addEventListener("click", () => {
    const table = head.closest("table"), body = table.tBodies[0], column = head.cellIndex;
    const first = head.dataset.sort === "text" || head.dataset.better === "low" ? "ascending" : "descending";
    const other = { ascending: "descending", descending: "ascending" };
    const way = head.hasAttribute("aria-sort") ? other[head.getAttribute("aria-sort")] : first;
    for (const one of table.tHead.rows[0].cells) one.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", way);
    const sign = way === "ascending" ? 1 : -1;
    const key = (row) => {
      const cell = row.cells[column];
      return head.dataset.sort === "text" ? cell.textContent : cell.dataset.value === "" ? null : +cell.dataset.value;
    };
    const order = (a, b) => {
      if (a === null || b === null) return (a === null) - (b === null); // what was not measured comes last
      return sign * (typeof a === "string" ? a.localeCompare(b) : a - b);
    };
    [...body.rows].sort((a, b) => order(key(a), key(b))).forEach((row) => body.append(row));
  });
}
