"""site_test.py PROGRAM SITE.PY: makes a site of two scenes and follows every link of it: to files and to places in them."""
import re
import subprocess
import sys
import tempfile
from html import unescape
from pathlib import Path

program, script = sys.argv[1:]
faults = []
with tempfile.TemporaryDirectory() as place:
    folder = Path(place, "site")
    subprocess.run([sys.executable, script, program, folder, "cube-plane", "goal-net"], check=True)
    pages = {page: page.read_text() for page in folder.rglob("*.html")}
    for wanted in ("index", "gallery", "readme", "docs/course", "play/cube-plane", "live/goal-net"):
        if folder / f"{wanted}.html" not in pages:
            faults.append(f"there is no {wanted}.html")
    for page, text in pages.items():
        where = page.relative_to(folder)
        if where.parts[0] in ("play", "live"):
            continue
        if text.count("<h1") != 1 and where.name != "gallery.html":
            faults.append(f"{where} has {text.count('<h1')} titles")
        for link in map(unescape, re.findall(r'(?:href|src)="([^"]*)"', text)):
            if link.startswith("https://"):
                continue
            path, _, anchor = link.partition("#")
            target = (page.parent / path).resolve() if path else page
            if not target.is_relative_to(folder.resolve()) or not target.exists():
                faults.append(f"{where}: {link} leads nowhere")
            elif anchor and f'id="{anchor}"' not in target.read_text():
                faults.append(f"{where}: there is no {link}")
        if loaded := re.findall(r'src="(https?:[^"]*)"', text):
            faults.append(f"{where} loads {loaded}")
        for left in ("\0", "](", "| --- |", "```"):
            if left in re.sub(r"<pre>.*?</pre>|<code>.*?</code>", "", text, flags=re.S):
                faults.append(f"{where} has {left!r} left")
print("\n".join(faults))
sys.exit(1 if faults else 0)
