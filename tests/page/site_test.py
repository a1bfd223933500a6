"""site_test.py ROOT PROGRAM MODULES: builds the documentation site with two scenes, and looks for known names in it."""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

root, program, modules = sys.argv[1:]
if subprocess.run([f"{root}/scripts/python.sh", "docs"]).returncode:
    print("Skipped: what builds the site is not here.")
    sys.exit()
python = f"{root}/build/docs/python/bin/python"
faults = []


def expect(page: str, *texts: str) -> None:
    text = Path(site, page).read_text() if Path(site, page).exists() else ""
    faults.extend(f"{page} lacks {wanted}" for wanted in texts if wanted not in text)


with tempfile.TemporaryDirectory() as folder:
    site = Path(folder, "html")
    build = [python, "-B", f"{root}/docs/site/build.py", program, modules, folder]
    subprocess.run([*build, "cube-plane", "goal-net"], check=True)
    expect("index.html", "<h1>Aspic", 'href="docs/physics.html"', 'href="python/index.html"', "copybutton.js")
    expect("docs/commands.html", 'id="aspic-run"', "highlight")
    expect("python/simulations.html", 'id="aspic.Simulation.step"', "Advance by")
    expect("python/gym.html", 'id="aspic.gym.Walk"')
    expect("cpp/batch.html", 'id="_CPPv4N5aspic5BatchE"', "Many models stepped together")
    expect("cpp/error.html", 'id="_CPPv4I0EN5aspic6ResultE"')
    expect("scenes/index.html", 'href="cube-plane.html"', 'href="goal-net.html"', "_images/goal-net.jpg")

    live = Path(site, "live/goal-net.html").exists()
    expect("recorded/goal-net.html", "<canvas")
    expect("scenes/goal-net.html", 'src="../live/goal-net.html"' if live else "scripts/wasm.sh", "[simulation]")

    index = json.loads(re.fullmatch(r"Search.setIndex\((.*)\)", Path(site, "searchindex.js").read_text(), re.S)[1])
    symbols = (("aspic", "Simulation"), ("aspic.Simulation", "step"), ("aspic.gym", "Walk"), ("", "aspic::Batch::run"))
    for part, name in symbols:
        if name not in {row[-1] for row in index["objects"].get(part, [])}:
            faults.append(f"the search index lacks the object {part}.{name}")
    for term, page in (("denorm", "docs/determinism"), ("coulomb", "docs/physics")):
        rows = [index[part].get(term, []) for part in ("terms", "titleterms")]
        numbers = [number for row in rows for number in (row if isinstance(row, list) else [row])]
        if index["docnames"].index(page) not in numbers:
            faults.append(f"a search for {term} does not find {page}")

    for wrong in ("nowhere.html", "index.html#nowhere", "../../outside.html"):
        Path(site, "planted.html").write_text(f'<a href="{wrong}">wrong</a>')
        checked = subprocess.run([python, f"{root}/docs/site/links.py", site], capture_output=True, text=True)
        if (checked.returncode, checked.stderr) != (1, f"planted.html: {wrong} leads nowhere\n"):
            faults.append(f"the link {wrong} is not noticed: {checked.stderr}")
print("\n".join(faults))
sys.exit(1 if faults else 0)
