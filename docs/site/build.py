"""build.py PROGRAM MODULES FOLDER [--external] [SCENE …]: builds the site, for scripts/docs.sh.

PROGRAM is aspic; MODULES has the Python package; without scenes, all have pages. The folder gets xml, from Doxygen;
source, for Sphinx: the pages of the repository with the files that they link to, a page for each scene, the APIs;
pages, runs of the scenes: recorded ones and, if the program has the module of scripts/wasm.sh, live ones; html, the site.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM, MODULES, FOLDER = sys.argv[1], sys.argv[2], Path(sys.argv[3]).resolve()
SOURCE, PAGES = FOLDER / "source", FOLDER / "pages"
sys.path.insert(0, MODULES)
import api  # noqa: E402

# Smaller bodies where a page would be long, or slow in a browser.
SMALLER = {
    "large-cube": ["--set=cube[0].particles-per-edge=24"],
    "heap": ["--set=simulation.timestep=0.002", *(f"--set=cube[{i}].particles-per-edge=3" for i in range(28))],
}
NOTE = """
:::{note}
This site was built without the WebAssembly module, so the runs are recorded.
For simulations in the browser, run `scripts/wasm.sh` and then `scripts/docs.sh`.
:::
"""
SCENES = """# Scenes

Every built-in scene, in the browser.
A *live* page computes the run there, and you can change parameters while it moves.
A *recorded* page shows a run that was computed before.
[A run as a page](../docs/page.md) describes both.
"""
SCENE = """# {name}

{description}
{smaller}
<iframe class="run" src="../{shown}/{name}.html" title="{name}, {shown}" loading="lazy"></iframe>

Open this run alone: {links}.
{note}
```sh
aspic view {name}
aspic run {name} --video {name}.mp4
```

## The scene file

`aspic scene show {name}` prints it; [the reference](../docs/scene-reference.md) explains every key.

```toml
{text}```
"""


def write(place: str, text: str) -> None:
    path = SOURCE / place
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def toctree(entries: Iterable[str], option: str) -> str:
    return "\n".join(["", "```{toctree}", option, *entries, "```", ""])


def copy_page(page: Path, place: str, lead: str = "", more: str = "") -> None:
    """Copies a page and the files of the repository that it links to. Links to directories become text; those that are
    named by a page's file get its title."""
    text = re.sub(r"\[[a-z/-]+\.md\]\(", "[](", page.read_text().replace("\n## ", f"\n{lead}## ", 1))
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


def write_documents() -> None:
    """The pages of the repository. docs/README.md, the list of them, is the navigation."""
    navigation, pages = "", set((ROOT / "docs").glob("*.md")) - {ROOT / "docs/README.md"}
    generated = {"Start": ["scenes/index"], "Reference": ["python/index", "cpp/index"]}
    for section in re.split(r"^## ", (ROOT / "docs/README.md").read_text(), flags=re.M)[1:]:
        title, entries = section.split("\n")[0], []
        for name, link in re.findall(r"\[([^\]]+)\]\(([^)#]+\.md)\)", section):
            page = (ROOT / "docs" / link).resolve()
            pages.add(page)
            entries.append(f"{name[0].upper()}{name[1:]} <{page.relative_to(ROOT).with_suffix('')}>")
        navigation += toctree([":hidden:", *entries, *generated.get(title, [])], f":caption: {title}")
    lead = "[Every built-in scene in your browser](scenes/index.md)\n\n"
    copy_page(ROOT / "README.md", "index.md", lead, navigation)
    for page in pages:
        copy_page(page, str(page.relative_to(ROOT)))


def write_api(folder: str, title: str, about: str, pages: dict[str, str]) -> None:
    for page, text in pages.items():
        write(f"{folder}/{page}.rst", text)
    write(f"{folder}/index.md", f"# {title}\n\n{about}\n" + toctree(pages, ":maxdepth: 1"))


def run(*words: str) -> str:
    done = subprocess.run([PROGRAM, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    # A scene that diverges has pages all the same.
    if done.returncode not in (0, 5):
        sys.exit(f"aspic {' '.join(words)} ended with {done.returncode}.\n{done.stderr}")
    return done.stdout


def has_module() -> bool:
    """Whether the program can write live pages."""
    with tempfile.TemporaryDirectory() as work:
        words = ["run", "cube-plane", "--steps", "1", "--html-live", f"{work}/page.html"]
        return subprocess.run([PROGRAM, *words], capture_output=True).returncode == 0


def make_runs(name: str, kinds: dict[str, str]) -> None:
    """The pages of a scene's run and its image, where the program is newer."""
    since, smaller = Path(PROGRAM).stat().st_mtime, SMALLER.get(name, [])
    places = {option: PAGES / kind / f"{name}.html" for kind, option in kinds.items()}
    old = [f"{option}={page}" for option, page in places.items() if not page.exists() or page.stat().st_mtime < since]
    if old:
        run("run", name, *smaller, *(["--fps", "30"] if smaller else []), "--force", *old)
    image = ROOT / f"docs/images/{name}.jpg"
    if not image.exists():
        frames = FOLDER / f"frames-{name}"
        if not frames.exists() or frames.stat().st_mtime < since:
            size = ["--fps", "1", "--size", "960x540", "--frames-format", "jpg"]
            run("run", name, *smaller, "--force", "--duration", "0.7", *size, "--frames", str(frames))
        image = sorted(frames.iterdir())[-1]
    shutil.copy(image, SOURCE / f"images/{name}.jpg")


def write_scenes(wanted: list[str]) -> None:
    scenes = json.loads(run("scene", "list", "--json"))["scenes"]
    if unknown := (set(wanted) | set(SMALLER)) - {scene["name"] for scene in scenes}:
        sys.exit(f"There is no built-in scene {', '.join(sorted(unknown))}.")
    scenes = [scene for scene in scenes if not wanted or scene["name"] in wanted]
    kinds = {"live": "--html-live", "recorded": "--html"} if has_module() else {"recorded": "--html"}
    for folder in (SOURCE / "images", PAGES / "live", PAGES / "recorded"):
        folder.mkdir(parents=True, exist_ok=True)
    for page in PAGES.glob("*/*.html"):
        if page.parent.name not in kinds or page.stem not in {scene["name"] for scene in scenes}:
            page.unlink()
    shown, note, group = next(iter(kinds)), "" if "live" in kinds else NOTE, ""
    gallery = SCENES + note
    for scene in scenes:
        name, description = scene["name"], scene["description"]
        make_runs(name, kinds)
        if scene["group"] != group:
            gallery += ":::\n" * bool(group) + f"\n## {scene['group']}\n\n:::{{container}} scenes\n"
            group = scene["group"]
        gallery += f"- [![](../images/{name}.jpg) **{name}**]({name}.md)<br>{description}\n"
        links = ", ".join(f'<a href="../{kind}/{name}.html">{kind}</a>' for kind in kinds)
        smaller = "\nThe run shown has fewer particles than the scene.\n" if name in SMALLER else ""
        text = (ROOT / f"assets/scenes/{name}.toml").read_text()
        write(f"scenes/{name}.md", SCENE.format_map(locals()))
    write("scenes/index.md", gallery + ":::\n" + toctree([scene["name"] for scene in scenes], ":hidden:"))


def sphinx(builder: str) -> None:
    # Everything is read again, since Sphinx does not repeat the warnings of pages that it read before.
    command = [sys.executable, "-m", "sphinx", "-b", builder, "-q", "-W", "-E", "-c", str(ROOT / "docs/site")]
    folders = ["-D", f"breathe_projects.aspic={FOLDER / 'xml'}", "-D", f"html_extra_path={PAGES}"]
    folders += ["-d", str(FOLDER / "doctrees"), str(SOURCE), str(FOLDER / builder)]
    subprocess.run([*command, *folders], env=os.environ | {"PYTHONPATH": MODULES}, check=True)


def main() -> None:
    external, scenes = "--external" in sys.argv[4:], [word for word in sys.argv[4:] if word != "--external"]
    for old in (FOLDER / "xml", SOURCE, FOLDER / "html"):
        shutil.rmtree(old, ignore_errors=True)
    FOLDER.mkdir(parents=True, exist_ok=True)
    doxyfile = (ROOT / "docs/site/Doxyfile").read_text() + f"\nOUTPUT_DIRECTORY = {FOLDER}\n"
    subprocess.run(["doxygen", "-"], input=doxyfile, text=True, cwd=ROOT, check=True)
    write_documents()
    about = "The public names of the package `aspic`. [The guide](../docs/python.md) teaches its use."
    write_api("python", "Python API", about, api.python_pages())
    about = "`aspic/aspic.h` includes all headers. [The guide](../docs/library.md) teaches the use of the library."
    write_api("cpp", "C++ API", about, api.cpp_pages(ROOT / "include/aspic", FOLDER / "xml"))
    write_scenes(scenes)
    sphinx("html")
    subprocess.run([sys.executable, ROOT / "docs/site/links.py", FOLDER / "html"], check=True)
    if external:
        sphinx("linkcheck")
    print(FOLDER / "html/index.html")


try:
    main()
except subprocess.CalledProcessError as failed:
    sys.exit(f"{failed.cmd[0]} of docs/site/build.py ended with {failed.returncode}; its messages are above.")
