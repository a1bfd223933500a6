"""links.py SITE: fails if a link within the site leads nowhere, or if a page loads something from elsewhere."""

import re
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote


class Page(HTMLParser):
    """What a page links to and loads, and the places in it that others may link to."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: set[str] = set()
        self.loads: set[str] = set()
        self.places = {""}
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        for key, value in attributes:
            if key == "id" and value:
                self.places.add(value)
            elif key in ("href", "src") and value:
                if not re.match(r"[a-z]+:|//", value):
                    self.links.add(value)
                elif key == "src" or tag == "link":
                    self.loads.add(value)


site = Path(sys.argv[1]).resolve()
# Pages of runs have no links.
pages = {page: Page(page.read_text()) for page in site.rglob("*.html") if page.parent.name not in ("live", "recorded")}
faults = []
for page, found in pages.items():
    where = page.relative_to(site)
    faults += [f"{where} loads {load}" for load in found.loads]
    for link in found.links:
        path, _, place = unquote(link).partition("#")
        target = (page.parent / path.partition("?")[0]).resolve() if path else page
        known = target.is_relative_to(site) and target.is_file()
        if not known or (target in pages and place not in pages[target].places):
            faults.append(f"{where}: {link} leads nowhere")
print("\n".join(sorted(faults)), end="\n" * bool(faults), file=sys.stderr)
sys.exit(1 if faults or not pages else 0)
