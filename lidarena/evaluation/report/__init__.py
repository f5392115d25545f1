"""``report.html``: one file, without network, that shows what an evaluation or a training came to.

The page is ours, tables, intervals and player in some 300 lines of JavaScript and CSS, because the plotting libraries
for browsers bring 1 to 5 MB into every file and none of them plays an episode; curves are Matplotlib's, as SVG.
"""

from lidarena.evaluation.report.page import write_page
from lidarena.evaluation.report.sources import ReportContent, content_of_folder

__all__ = ["ReportContent", "content_of_folder", "write_page"]
