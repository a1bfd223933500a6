"""build.py PROGRAM MODULES FOLDER [--external] [SCENE …]: what scripts/docs.sh runs after it has built the program and the Python package.

FOLDER/xml is what Doxygen finds, FOLDER/source what Sphinx reads: the pages of the repository with the files that they link to, and a page
for each scene and each part of the APIs. FOLDER/pages has runs of the scenes: recorded ones and, if the program has the module of
scripts/wasm.sh, live ones. FOLDER/html is the site.
"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parents[2]
PROGRAM, MODULES, FOLDER = sys.argv[1], sys.argv[2], Path(sys.argv[3]).resolve()
SOURCE, PAGES = FOLDER / "source", FOLDER / "pages"
sys.path.insert(0, MODULES)
import aspic  # noqa: E402
import aspic.gym  # noqa: E402

# Smaller bodies where a page would be long, or slow in a browser.
SMALLER = {
    "large-cube": ["--set", "cube[0].particles-per-edge=24", "--fps", "30"],
    "heap": ["--set", "simulation.timestep=0.002", *(f"--set=cube[{i}].particles-per-edge=3" for i in range(28)), "--fps", "30"],
}
PYTHON = {
    "Scenes": ["load", "scenes", "parameters", "Scene", "BuiltinScene", "Parameter"],
    "Simulations": ["Simulation", "resume", "Advance", "SolveStatistics", "Pull", "Body", "Ball", "Skin", "Measures", "Quantities", "Springs"],
    "States": ["State", "compare", "Difference", "QuantityDifference"],
    "Trajectories": ["Trajectory", "BatchTrajectory", "Energy", "Diagnostic"],
    "Batches": ["Batch", "Instance"],
    "Sweeps": ["sweep", "collect", "Table"],
    "Devices": ["devices", "Device"],
    "Errors and warnings": ["Error", "ErrorCode", "UsageError", "SceneError", "DivergedError", "DeviceError", "FileError", "CheckError",
                            "InterruptedRun", "RunWarning", "StepWarning", "OverlapWarning", "ConvergenceWarning"],
}  # fmt: skip
# Members of bases that are not public, and of no others.
MEMBERS = """   :members:
   :show-inheritance:
   :inherited-members: object, tuple, int, Enum, BaseException, OSError, Error, Mapping, ndarray, BatchEnv, SingleEnv, Env, VectorEnv
"""
GYM = ["BatchEnv", "SingleEnv", "Walk", "WalkEnv", "walker", "Crawl", "CrawlEnv", "crawler"]


def write(place: str, text: str) -> None:
    path = SOURCE / place
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def toctree(entries: Iterable[str], caption: str = "", options: str = ":hidden:") -> str:
    return "\n".join(["", "```{toctree}", options, *([f":caption: {caption}"] if caption else []), *entries, "```", ""])


def copy_page(page: Path, place: str, more: str = "") -> None:
    """Copies a page and the files of the repository that it links to; links to directories become text."""
    text = page.read_text()
    for link in set(re.findall(r"\]\(([^)#\s]+)", text)):
        target = (page.parent / link).resolve()
        if target in (ROOT / "README.md", ROOT / "docs/README.md"):
            text = text.replace(f"]({link}", f"]({'../' * place.count('/')}index.md")
        elif target.is_dir():
            text = re.sub(rf"\[([^\]]*)\]\({re.escape(link)}\)", r"\1", text)
        elif target.is_relative_to(ROOT) and target.is_file() and target.suffix != ".md":
            copied = SOURCE / target.relative_to(ROOT)
            copied.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(target, copied)
    write(place, text + more)


def documents() -> None:
    """The pages of the repository; docs/README.md, the map of them, is the navigation."""
    trees, pages = [], set((ROOT / "docs").glob("*.md"))
    for section in re.split(r"^## ", (ROOT / "docs/README.md").read_text(), flags=re.M)[1:]:
        entries = []
        for name, link in re.findall(r"\[([^\]]+)\]\(([^)#]+\.md)\)", section):
            page = (ROOT / "docs" / link).resolve()
            pages.add(page)
            entries.append(f"{name} <{page.relative_to(ROOT).with_suffix('')}>")
        extra = {"Start": ["scenes/index"], "Reference": ["python/index", "cpp/index"]}.get(section.split("\n")[0], [])
        trees.append(toctree(entries + extra, section.split("\n")[0]))
    copy_page(ROOT / "README.md", "index.md", "".join(trees))
    for page in pages - {ROOT / "docs/README.md"}:
        copy_page(page, str(page.relative_to(ROOT)))


def reference(name: str, title: str, lead: str, pages: dict[str, str]) -> None:
    """Pages of an API, by file name, and the page that lists them."""
    for page, text in pages.items():
        write(f"{name}/{page}.rst", text)
    write(f"{name}/index.md", f"# {title}\n\n{lead}\n" + toctree(pages, options=":maxdepth: 1"))


def heading(title: str) -> str:
    return f"{title}\n{'=' * len(title)}\n\n"


def python_reference() -> None:
    if difference := {name for names in PYTHON.values() for name in names} ^ set(aspic.__all__):
        sys.exit(f"docs/site/build.py and aspic.__all__ differ in {', '.join(sorted(difference))}.")
    if difference := {*GYM, "AutoresetMode"} ^ set(aspic.gym.__all__):
        sys.exit(f"docs/site/build.py and aspic.gym.__all__ differ in {', '.join(sorted(difference))}.")

    def part(module: str, names: list[str]) -> str:
        kinds = [(name, "class" if isinstance(getattr(sys.modules[module], name), type) else "function") for name in names]
        return f".. currentmodule:: {module}\n\n" + "".join(f".. auto{kind}:: {name}\n{MEMBERS * (kind == 'class')}"
                                                            f"{'   :undoc-members:' * (name == 'ErrorCode')}\n\n" for name, kind in kinds)

    pages = {title.split()[0].lower(): heading(title) + part("aspic", names) for title, names in PYTHON.items()}
    pages["gym"] = heading("aspic.gym") + ".. automodule:: aspic.gym\n\n" + part("aspic.gym", GYM)
    reference("python", "Python API", "The public names of the package `aspic`. [The guide](../docs/python.md) teaches its use.", pages)


def cpp_reference() -> None:
    """A page for each header, of Doxygen's XML: its declarations in order."""
    xml = FOLDER / "xml"
    rows: dict[str, list[tuple[int, str]]] = {}

    def add(place: ElementTree.Element, directive: str) -> None:
        rows.setdefault(Path(place.get("file", "")).name, []).append((int(place.get("line", "0")), directive))

    for found in ElementTree.parse(xml / "index.xml").findall("compound"):
        if found.get("kind") not in ("class", "struct"):
            continue
        compound = ElementTree.parse(xml / f"{found.get('refid')}.xml").find("compounddef")
        name = compound.findtext("compoundname")
        if name.count("::") == 1:  # others are shown in theirs
            add(compound.find("location"), f"doxygen{found.get('kind')}:: {name}\n   :members:\n   :undoc-members:")
    members = ElementTree.parse(xml / "namespaceaspic.xml").findall("compounddef/sectiondef/memberdef")
    count = Counter(member.findtext("name") for member in members)
    for member in members:
        name, kind = member.findtext("name"), member.get("kind")
        arguments = member.findtext("argsstring") if kind == "function" and count[name] > 1 else ""
        add(member.find("location"), f"doxygen{kind}:: aspic::{name}{arguments}")
    pages = {}
    for header, directives in sorted(rows.items()):
        about = re.match(r"#pragma once\n((?:// .*\n)+)", (ROOT / "include/aspic" / header).read_text())[1].replace("// ", "")
        pages[Path(header).stem] = heading(f"aspic/{header}") + about + "".join(f"\n.. {row}\n" for _, row in sorted(directives))
    reference("cpp", "C++ API", "The public headers of `libaspic`; `aspic/aspic.h` includes them all. "
              "[The guide](../docs/library.md) teaches their use.", pages)


def run(*words: str) -> str:
    done = subprocess.run([PROGRAM, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    # A scene that diverges has pages all the same.
    if done.returncode not in (0, 5):
        sys.exit(f"aspic {' '.join(words)} ended with {done.returncode}.\n{done.stderr}")
    return done.stdout


def scene_pages(name: str, live: bool) -> None:
    """The recorded page, the live one and the picture, where they are older than the program."""
    smaller = SMALLER.get(name, [])
    since = Path(PROGRAM).stat().st_mtime
    made = [("--page", PAGES / f"recorded/{name}.html"), *([("--page-live", PAGES / f"live/{name}.html")] if live else [])]
    old = [(option, str(page)) for option, page in made if not page.exists() or page.stat().st_mtime < since]
    if old:
        run("run", name, *smaller, "--force", *(word for pair in old for word in pair))
    picture = SOURCE / f"images/{name}.jpg"
    if (drawn := ROOT / f"docs/images/{name}.jpg").exists():
        shutil.copy(drawn, picture)
        return
    frames = FOLDER / f"frames-{name}"
    if not frames.exists() or frames.stat().st_mtime < since:
        run("run", name, *smaller[:-2], "--force", "--duration", "0.7", "--fps", "1", "--size", "960x540", "--frames-format", "jpg",
            "--frames", str(frames))
    shutil.copy(sorted(frames.iterdir())[-1], picture)


def scenes(names: list[str]) -> None:
    rows = json.loads(run("scene", "list", "--json"))["scenes"]
    if unknown := (set(names) | set(SMALLER)) - {row["name"] for row in rows}:
        sys.exit(f"There is no built-in scene {', '.join(sorted(unknown))}.")
    rows = [row for row in rows if not names or row["name"] in names]
    for folder in (SOURCE / "images", PAGES / "recorded", PAGES / "live"):
        folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:  # whether the program has the module
        live = not subprocess.run([PROGRAM, "run", "cube-plane", "--steps", "1", "--page-live", f"{work}/page.html"], capture_output=True).returncode
    needed = "" if live else ("\n:::{note}\nThis site was built without the WebAssembly module, so that runs are recorded. For simulations in "
                              "the browser, run `scripts/wasm.sh` and build the site again.\n:::\n")
    gallery = ["# Scenes", "", "Every built-in scene, in the browser. A *live* page computes the run there, and its parameters can be changed "
               "while it moves. A *recorded* page shows a run that was computed before. "
               "[A run as a page](../docs/page.md) describes both.", needed]
    group = ""
    for row in rows:
        name, words = row["name"], row["description"]
        scene_pages(name, live)
        if row["group"] != group:
            gallery += ([":::"] if group else []) + ["", f"## {row['group']}", "", ":::{container} scenes"]
            group = row["group"]
        gallery.append(f"- [![](../images/{name}.jpg) **{name}**]({name}.md)<br>{words}")
        shown = "live" if live else "recorded"
        links = [f'<a href="../{kind}/{name}.html">{kind}</a>' for kind in (("live", "recorded") if live else ("recorded",))]
        smaller = "\nThe run shown has fewer particles than the scene.\n" if name in SMALLER else ""
        write(f"scenes/{name}.md", f"""# {name}

{words}
{smaller}
<iframe class="run" src="../{shown}/{name}.html" title="{name}, {shown}" loading="lazy"></iframe>

Open this run alone: {", ".join(links)}.
{needed}
```sh
aspic view {name}                      # in a window
aspic run {name} --video {name}.mp4    # as a film
```

## The scene file

`aspic scene show {name}` prints it; [the reference](../docs/scene-reference.md) explains every key.

```toml
{(ROOT / f"assets/scenes/{name}.toml").read_text()}```
""")
    write("scenes/index.md", "\n".join(gallery + [":::", toctree([row["name"] for row in rows])]))


def sphinx(builder: str) -> None:
    subprocess.run([sys.executable, "-m", "sphinx", "-b", builder, "-q", "-W", "-E", "-d", FOLDER / "doctrees", "-c", ROOT / "docs/site",
                    "-D", f"breathe_projects.aspic={FOLDER / 'xml'}", "-D", f"html_extra_path={PAGES}", SOURCE, FOLDER / builder],
                   env=os.environ | {"PYTHONPATH": MODULES}, check=True)  # fmt: skip


def main() -> None:
    external, names = "--external" in sys.argv[4:], [word for word in sys.argv[4:] if word != "--external"]
    FOLDER.mkdir(parents=True, exist_ok=True)
    subprocess.run(["doxygen", "-"], input=f"{(ROOT / 'docs/site/Doxyfile').read_text()}\nOUTPUT_DIRECTORY = {FOLDER}\n",
                   text=True, cwd=ROOT, check=True)  # fmt: skip
    for old in (SOURCE, FOLDER / "html"):
        shutil.rmtree(old, ignore_errors=True)
    documents()
    python_reference()
    cpp_reference()
    scenes(names)
    sphinx("html")
    subprocess.run([sys.executable, ROOT / "docs/site/links.py", FOLDER / "html"], check=True)
    if external:
        sphinx("linkcheck")
    print(FOLDER / "html/index.html")


try:
    main()
except subprocess.CalledProcessError as failed:
    sys.exit(f"{failed.cmd[0]} of docs/site/build.py ended with {failed.returncode}; its messages are above.")
