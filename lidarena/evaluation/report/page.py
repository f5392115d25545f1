"""The page itself: HTML with everything inside, style, scripts, pictures and episodes."""

import base64
import json
import zlib
from collections.abc import Sequence
from html import escape
from importlib.resources import files
from pathlib import Path
from string import Template

import lidarena
from lidarena.base.files import write_text
from lidarena.evaluation.report.answer import answers, headline
from lidarena.evaluation.report.interval_table import interval_table
from lidarena.evaluation.report.sources import Figure, Player, ReportContent
from lidarena.evaluation.results import Row
from lidarena.evaluation.tables import by_env, counted_episodes, note

REPORT_FILE = "report.html"
_PAGE = Template("""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>$title · Lidarena</title>
<meta name="viewport" content="width=device-width, initial-scale=1"><link rel="icon" href="data:,">
<style>$style</style></head><body>
<header><h1>$title</h1>$answer</header>
<main>$body</main>
<footer>Lidarena $version. This file holds everything it shows and loads nothing.</footer>
<script type="text/plain" id="replays">$replays</script>
<script>$script</script></body></html>
""")
_PLAYER = """<section id="player"><h2>Episodes</h2>
<p class="controls"><select id="env" aria-label="environment"></select> <button id="play">Play</button>
<input id="time" type="range" min="0" max="1000" value="0" step="1" aria-label="time"> <output id="clock">0.0 s</output>
<label>speed <select id="speed"><option>1</option><option>2</option><option>5</option><option selected>10</option>
<option>20</option><option>50</option></select> ×</label></p>
<p class="controls" id="layers"></p>
<div class="views"><figure><figcaption><select class="policy" aria-label="left policy"></select></figcaption>
<canvas width="640" height="560"></canvas></figure><figure><figcaption><select class="policy" aria-label="right policy">
</select></figcaption><canvas width="640" height="560"></canvas></figure></div></section>"""


def write_page(path: Path, content: ReportContent) -> Path:
    """Write a report; the file appears whole or not at all.

    Raises:
        WriteError: Its place is not writable or full.
    """
    return write_text(path, page(content))


def page(content: ReportContent) -> str:
    """Return a report as HTML."""
    body = []
    if content.missing:
        body.append(f"<ul class='missing'>{''.join(f'<li>{escape(one)}</li>' for one in content.missing)}</ul>")
    body += [_tables(content.rows)] if content.rows else []
    body += [_figures([one for one in content.figures if one.kind == "svg"], "Curves")]
    body += [_PLAYER] if content.players else []
    body += [_figures([one for one in content.figures if one.kind == "png"], "Pictures")]
    for heading, text in content.details.items():
        body.append(f"<details><summary>{escape(heading)}</summary><pre>{escape(text)}</pre></details>")
    return _PAGE.substitute(
        title=escape(content.title),
        style=_resource("report.css"),
        script=_resource("table.js") + (_resource("player.js") if content.players else ""),
        answer=_answer(content),
        body="\n".join(body),
        version=lidarena.__version__,
        replays=_packed(content.players),
    )


def _resource(name: str) -> str:
    return (files("lidarena.evaluation.report") / name).read_text(encoding="utf-8")


def _answer(content: ReportContent) -> str:
    if not content.rows:
        return "".join(f"<p class='answer'>{escape(fact)}</p>" for fact in content.facts)
    found = answers(content.rows)
    lines = "".join(f"<li><b>{escape(one.env)}</b>: {escape(one.sentence)}</li>" for one in found)
    return f"<p class='answer'>{escape(headline(found, content.rows))}</p><ul class='answers'>{lines}</ul>"


def _tables(rows: Sequence[Row]) -> str:
    parts = ["<section id='tables'><h2>Results</h2><p class='hint'>Click on a heading to sort.</p>"]
    for group in by_env(rows):
        parts.append(f"<h3>{escape(group[0].env)} <small>{counted_episodes(group)} each</small></h3>")
        parts.append(f"<div class='wide'>{interval_table(group)}</div>")
        every = interval_table(group, main=False)
        parts.append(f"<details><summary>All measures</summary><div class='wide'>{every}</div></details>")
    return "".join([*parts, f"<p class='hint'>{escape(note(rows))}</p></section>"])


def _figures(figures: Sequence[Figure], heading: str) -> str:
    """Pictures; beyond the first two they are unfolded one by one."""
    if not figures:
        return ""
    parts = []
    for place, figure in enumerate(figures):
        if figure.kind == "svg":
            shown = figure.data.decode()
        else:
            data = base64.b64encode(figure.data).decode()
            shown = f"<img alt='{escape(figure.title, quote=True)}' src='data:image/png;base64,{data}'>"
        opened = " open" if place < 2 else ""
        parts.append(f"<details{opened}><summary>{escape(figure.title)}</summary>{shown}</details>")
    return f"<section class='pictures'><h2>{heading}</h2>{''.join(parts)}</section>"


def _packed(players: Sequence[Player]) -> str:
    """Episodes as JSON, deflated, in base64; the browser unpacks them."""
    if not players:
        return ""
    episodes = [{"env": one.env, "policy": one.policy, **one.replay.content} for one in players]
    text = json.dumps(episodes, separators=(",", ":"), allow_nan=False)
    return base64.b64encode(zlib.compress(text.encode(), 9)).decode()
