"""site.py PROGRAM FOLDER [SCENE …]: what scripts/site.sh makes, with a program that has the module of live pages."""
import html
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# Smaller bodies where a page would be long, or slow in a browser.
SMALLER = {
    "large-cube": ["--set", "cube[0].particles-per-edge=24", "--fps", "30"],
    "heap": ["--set", "simulation.timestep=0.002", *(f"--set=cube[{i}].particles-per-edge=3" for i in range(28)), "--fps", "30"],
}

STYLE = """:root{color-scheme:light dark;--ink:#1d2126;--soft:#5b6068;--paper:#fff;--wash:#f3f4f6;--rule:#d9dce1;--mark:#0b5f9e}
@media (prefers-color-scheme:dark){:root{--ink:#e6e7e9;--soft:#a3aab4;--paper:#15181c;--wash:#1f2329;--rule:#363c45;--mark:#7cc0f5}}
*{box-sizing:border-box}body{margin:0;background:var(--paper);color:var(--ink);font:16px/1.55 system-ui,-apple-system,"Segoe UI","DejaVu Sans",sans-serif}
nav{display:flex;gap:.3rem 1.4rem;flex-wrap:wrap;align-items:baseline;padding:.8rem max(1rem,calc(50% - 35rem));border-bottom:1px solid var(--rule)}
nav strong{font-size:1.1rem}main{max-width:72rem;margin:0 auto;padding:1rem 1rem 4rem}a{color:var(--mark)}
h1{font-size:1.9rem;line-height:1.2;margin:1.2rem 0 .6rem}h2{margin:2.2rem 0 .6rem;font-size:1.25rem}h3{font-size:1.05rem}
.lead{max-width:46rem;color:var(--soft);font-size:1.08rem}img{max-width:100%;height:auto;border-radius:8px;display:block}
.scenes{display:grid;grid-template-columns:repeat(auto-fill,minmax(19rem,1fr));gap:1.2rem;padding:0;list-style:none}
.scenes li{border:1px solid var(--rule);border-radius:12px;overflow:hidden;display:flex;flex-direction:column;background:var(--wash)}
.scenes img{border-radius:0;width:100%;aspect-ratio:16/9;object-fit:cover}.scenes h3{margin:.8rem 1rem 0}.scenes p{margin:.3rem 1rem .8rem;color:var(--soft);font-size:.94rem;flex:1}
.go{display:flex;gap:.6rem;margin:0 1rem 1rem}.go a{flex:1;text-align:center;text-decoration:none;padding:.45rem;border-radius:8px;border:1px solid var(--mark);font-weight:600}
.go a:first-child{background:var(--mark);color:var(--paper)}
.table{overflow-x:auto}table{border-collapse:collapse;font-size:.92rem;margin:.8rem 0}th,td{border:1px solid var(--rule);padding:.35rem .6rem;text-align:left;vertical-align:top}
th:empty{padding:0;border:0}td img{min-width:14rem}code{font:.88em ui-monospace,"DejaVu Sans Mono",monospace;background:var(--wash);padding:.1em .3em;border-radius:4px}
td code{overflow-wrap:anywhere}pre{background:var(--wash);padding:.8rem 1rem;border-radius:8px;overflow-x:auto}pre code{background:none;padding:0}
"""


class Document:
    """Markdown as docs/ has it, to HTML: headings, paragraphs, lists, tables, code, links and pictures."""

    def __init__(self, source: Path, place: Path, places: dict[Path, Path]) -> None:
        self.source, self.place, self.places = source, place, places

    def target(self, link: str) -> str | None:
        """Where a link leads within the site; None: nowhere."""
        if re.match(r"[a-z]+:", link):
            return link
        path, _, anchor = link.partition("#")
        if not path:
            return link
        file = (self.source.parent / path).resolve()
        if file not in self.places:
            return None
        ups = "../" * len(self.place.parent.parts)
        return ups + self.places[file].as_posix() + (f"#{anchor}" if anchor else "")

    def inline(self, text: str) -> str:
        kept: list[str] = []

        def keep(made: str) -> str:
            kept.append(made)
            return f"\0{len(kept) - 1}\0"

        def link(match: re.Match[str]) -> str:
            to, words = self.target(match[2]), match[1]
            return keep(f'<a href="{html.escape(to)}">') + words + keep("</a>") if to else words

        def picture(match: re.Match[str]) -> str:
            to = self.target(match[2])
            return keep(f'<img src="{html.escape(to)}" alt="{html.escape(match[1])}" loading="lazy">') if to else ""

        text = re.sub(r"(`+)(.+?)\1", lambda m: keep(f"<code>{html.escape(m[2].strip())}</code>"), text)
        text = re.sub(r"!\[([^\]]*)\]\(([^)\s]+)\)", picture, text)
        text = re.sub(r"\[([^\]]+)\]\(([^)\s]+)\)", link, text)
        text = html.escape(re.sub(r"\\([|*_\[\]`])", r"\1", text), quote=False)
        text = re.sub(r"\*\*(.+?)\*\*", r"<strong>\1</strong>", text)
        text = re.sub(r"(?<![\w*])\*(\S.*?\S|\S)\*(?![\w*])", r"<em>\1</em>", text)
        while "\0" in text:
            text = re.sub("\0(\\d+)\0", lambda m: kept[int(m[1])], text)
        return text

    def cells(self, line: str, tag: str) -> str:
        # A bar within code or behind a backslash is none.
        line = re.sub(r"`[^`]*`", lambda m: m[0].replace("\\|", "\1").replace("|", "\1"), line.strip().strip("|"))
        cells = [cell.strip().replace("\1", "|") for cell in re.split(r"(?<!\\)\|", line)]
        return "<tr>" + "".join(f"<{tag}>{self.inline(cell)}</{tag}>" for cell in cells) + "</tr>"

    def body(self) -> str:
        lines, out, at = self.source.read_text().splitlines(), [], 0
        while at < len(lines):
            line = lines[at]
            end = at + 1
            if line.startswith("```"):
                while not lines[end].startswith("```"):
                    end += 1
                code = "\n".join(lines[at + 1:end])
                out.append(f"<pre><code>{html.escape(code)}</code></pre>")
                end += 1
            elif line.startswith("    "):
                while end < len(lines) and (lines[end].startswith("    ") or not lines[end].strip()):
                    end += 1
                code = "\n".join(text[4:] for text in lines[at:end]).rstrip()
                out.append(f"<pre><code>{html.escape(code)}</code></pre>")
            elif heading := re.match(r"(#+) (.*)", line):
                slug = re.sub(r"[^\w\- ]", "", heading[2].lower()).replace(" ", "-")
                level = len(heading[1])
                out.append(f'<h{level} id="{slug}">{self.inline(heading[2])}</h{level}>')
            elif line.startswith("|"):
                while end < len(lines) and lines[end].startswith("|"):
                    end += 1
                rows = [self.cells(lines[at], "th"), *(self.cells(row, "td") for row in lines[at + 2:end])]
                out.append(f'<div class="table"><table>{"".join(rows)}</table></div>')
            elif item := re.match(r"(- |\d+\. )", line):
                tag, items = ("ul" if item[1] == "- " else "ol"), [line[len(item[1]):]]
                while end < len(lines) and (lines[end].startswith("  ") or re.match(r"(- |\d+\. )", lines[end])):
                    if more := re.match(r"(- |\d+\. )", lines[end]):
                        items.append(lines[end][len(more[1]):])
                    else:
                        items[-1] += " " + lines[end].strip()
                    end += 1
                out.append(f"<{tag}>" + "".join(f"<li>{self.inline(text)}</li>" for text in items) + f"</{tag}>")
            elif line.strip():
                while end < len(lines) and lines[end].strip() and not re.match(r"(#|\||```|- |\d+\. )", lines[end]):
                    end += 1
                out.append(f"<p>{self.inline(' '.join(lines[at:end]))}</p>")
            at = end
        return "\n".join(out)


def page(title: str, body: str, ups: str) -> str:
    """A page of the site; `ups`: the way to its root."""
    links = [("index.html", "Scenes"), ("gallery.html", "Gallery"), ("docs/course.html", "The course"),
             ("docs/physics.html", "Physics"), ("docs/commands.html", "Commands"), ("readme.html", "All documents")]
    nav = "".join(f'<a href="{ups}{to}">{name}</a>' for to, name in links)
    return f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width,initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'self'; img-src 'self'">
<title>{html.escape(title)}</title><link rel="stylesheet" href="{ups}site.css"></head>
<body><nav><strong>Aspic</strong>{nav}</nav><main>
{body}
</main></body></html>
"""


def run(program: str, *words: str) -> str:
    done = subprocess.run([program, *words], stdout=subprocess.PIPE, text=True)
    # A scene that diverges has pages all the same.
    if done.returncode not in (0, 5):
        sys.exit(f"aspic {' '.join(words)} ended with {done.returncode}.")
    return done.stdout


def write_scene(program: str, folder: Path, name: str) -> None:
    more = SMALLER.get(name, [])
    run(program, "run", name, *more, "--force", "--page", str(folder / f"play/{name}.html"),
        "--page-live", str(folder / f"live/{name}.html"))
    if (folder / f"images/{name}.jpg").exists():
        return
    with tempfile.TemporaryDirectory() as work:
        run(program, "run", name, *more[:-2], "--duration", "0.7", "--fps", "1", "--size", "960x540", "--frames-format", "jpg",
            "--frames", f"{work}/frames")
        shutil.copy(sorted(Path(work, "frames").iterdir())[-1], folder / f"images/{name}.jpg")


def index(scenes: list[dict[str, str]]) -> str:
    body = """<h1>Soft bodies, the same bits everywhere</h1>
<p class="lead">Jelly cubes, nets, cloth and balls made of point masses and springs. <em>Play</em> shows a run that was computed before, from
any side. <em>Simulate</em> computes it in this browser, where every number can be changed, and compares its bits with those of
the machine that made this site.</p>"""
    group = None
    for scene in scenes:
        if scene["group"] != group:
            body += ("</ul>" if group else "") + f"\n<h2>{html.escape(scene['group'])}</h2><ul class=\"scenes\">"
            group = scene["group"]
        name, words = scene["name"], html.escape(scene["description"])
        body += f"""
<li><img src="images/{name}.jpg" alt="{words}" width="960" height="540" loading="lazy"><h3>{name}</h3><p>{words}</p>
<div class="go"><a href="live/{name}.html">Simulate</a><a href="play/{name}.html">Play</a></div></li>"""
    return page("Aspic", body + "</ul>", "")


def main() -> None:
    program, folder, *names = sys.argv[1], Path(sys.argv[2]), *sys.argv[3:]
    scenes = json.loads(run(program, "scene", "list", "--json"))["scenes"]
    if unknown := set(names) - {scene["name"] for scene in scenes}:
        sys.exit(f"There is no built-in scene {', '.join(sorted(unknown))}.")
    if gone := set(SMALLER) - {scene["name"] for scene in scenes}:
        sys.exit(f"There is no built-in scene {', '.join(sorted(gone))}, which was to be smaller.")
    scenes = [scene for scene in scenes if not names or scene["name"] in names]
    for part in ("play", "live", "docs"):
        (folder / part).mkdir(parents=True, exist_ok=True)
    shutil.copytree(ROOT / "docs/images", folder / "images", dirs_exist_ok=True)
    (folder / "site.css").write_text(STYLE)
    places = {image: Path("images") / image.name for image in (ROOT / "docs/images").iterdir()}
    places |= {source: Path("docs") / f"{source.stem}.html" for source in (ROOT / "docs").glob("*.md")}
    places |= {ROOT / "README.md": Path("readme.html"), ROOT / "CHANGELOG.md": Path("changelog.html")}
    for source, place in places.items():
        if source.suffix == ".md":
            document, title = Document(source, place, places), source.read_text().split("\n", 1)[0].lstrip("# ")
            (folder / place).write_text(page(f"{title} – Aspic", document.body(), "../" * len(place.parent.parts)))
    text = (ROOT / "README.md").read_text()
    start = text.index("## Gallery")
    with tempfile.TemporaryDirectory() as work:
        part = Path(work, "gallery.md")
        part.write_text(text[start:text.index("\n## ", start)].rsplit("\n\n", 1)[0])
        document = Document(part, Path("gallery.html"), places)
        document.target = Document(ROOT / "README.md", Path("gallery.html"), places).target  # type: ignore[method-assign]
        (folder / "gallery.html").write_text(page("Gallery – Aspic", document.body(), ""))
    for scene in scenes:
        write_scene(program, folder, scene["name"])
        print(f"{scene['name']}: {(folder / 'play' / (scene['name'] + '.html')).stat().st_size:,} bytes to play, "
              f"{(folder / 'live' / (scene['name'] + '.html')).stat().st_size:,} to simulate", flush=True)
    (folder / "index.html").write_text(index(scenes))
    print(f"{folder}/index.html")


main()
