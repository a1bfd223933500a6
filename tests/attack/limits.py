"""The ends of every range: whatever is accepted ends with exit 0 and finite numbers, or is refused (3), or diverges (5).
Keys and ranges are those of docs/scene-reference.md, which is the program's own table."""
import json
import math
import os
import random
import re

from attack import DIVERGED, OK, SCENE, TINY, USAGE, main, read, write

LISTS = {"[[terrain]]": "terrain[0].", "[[cube]]": "cube[0].", "[[goal-net]]": "goal-net[0].", "[[cloth]]": "cloth[0].",
         "[[ball]]": "ball[0].",
         "[[launcher]]": "launcher[0].", "[simulation]": "simulation.", "[contact]": "contact."}
NUMBER = re.compile(r"^(three numbers \[x, y, z\], each |two numbers \[along x, y\], each |a number )(> 0 and ≤ |)(\S+)(?: … (\S+))?")
PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "docs", "scene-reference.md")


def ranges():
    """(path, components or 0, least, largest) of every number in the reference."""
    prefix = None
    for line in read(PAGE).decode().splitlines():
        heading = re.match(r"## `(\[.*\])`", line)
        if heading:
            prefix = LISTS.get(heading.group(1))
        cells = [c.strip() for c in line.split("|")]
        if prefix is None or len(cells) < 6 or not cells[1].startswith("`"):
            continue
        allowed = NUMBER.match(cells[3])
        if not allowed:
            continue
        first = float(allowed.group(3).rstrip(","))
        positive = allowed.group(2) != ""
        last = float(allowed.group(4).rstrip(",")) if allowed.group(4) else first
        yield prefix + cells[1].strip("`"), {"three": 3, "two": 2}.get(allowed.group(1).split()[0], 0), 0.0 if positive else first, last, positive


def values(least, largest, positive):
    smallest = [5e-324, 1.9e-38, 1e-45, 1e-20] if positive else [least, 1.9e-38]
    return [*smallest, largest, largest * 0.999, math.sqrt(max(largest, 0.0)), 1e-9 * largest]


def finite(text):
    """Whether every number of a JSON text or of a table is finite."""
    words = re.split(r"[\s,:\[\]{}\"]+", text)
    return not any(w.lower().lstrip("-+") in ("nan", "inf", "infinity") for w in words)


def look(attack, words, note, codes=(OK, SCENE, DIVERGED)):
    series, state = attack.path("series.csv"), attack.path("state.csv")
    for path in (series, state):
        if os.path.exists(path):
            os.remove(path)
    done = attack.run(*words, "--json", "--series", series, "--state", state, timeout=60)
    if not attack.judge(done, codes, note):
        return
    if done.code == SCENE:
        return
    text = done.out.decode()
    attack.require(finite(text), f"{note}: a number that is not finite was printed: {done} {text}")
    json.loads(text)
    for path in (series, state):
        if os.path.exists(path):
            attack.require(finite(read(path).decode()), f"{note}: {os.path.basename(path)} has a number that is not finite")


SCENES = {"cube[0].": "cube-plane", "goal-net[0].": "goal-net", "cloth[0].": "flag", "ball[0].": "cube-and-balls", "launcher[0].": "penalty",
          "terrain[0].": "cube-plane", "simulation.": "cube-plane", "contact.": "cube-and-balls"}
SMALL = {"cube-plane": TINY, "goal-net": ["--set", "goal-net[0].particles=[3,3,3]"], "flag": ["--set", "cloth[0].particles=[3,3]"], "cube-and-balls": TINY,
         "penalty": ["--set", "goal-net[0].particles=[3,3,3]", "--set", "launcher[0].count=4"]}


def methods():
    """Every integrator the reference of scenes has."""
    row = next(line for line in read(PAGE).decode().splitlines() if line.startswith("| `integrator` |"))
    return re.findall(r'"([a-z0-9-]+)"', row.split("|")[3])


METHODS = methods()


def one_at_a_time(attack):
    table = list(ranges())
    attack.require(len(table) > 40, f"only {len(table)} keys were found in the reference")
    rounds = METHODS if attack.thorough else ["explicit-euler", "implicit-euler"]
    for path, vector, least, largest, positive in table:
        scene = SCENES[next(prefix for prefix in SCENES if path.startswith(prefix))]
        chosen = values(least, largest, positive)
        for value in chosen if attack.thorough else random.sample(chosen, 3):
            written = "[" + ", ".join([repr(value)] * vector) + "]" if vector else repr(value)
            for method in rounds:
                words = ["run", scene, "--backend", "reference", *SMALL[scene], "--set", f"simulation.integrator={method}", "--set", f"{path}={written}",
                         "--steps", "4"]
                look(attack, words, f"{path}={written}, {method}", (OK, USAGE, SCENE, DIVERGED))


def several_at_once(attack):
    """Random scenes of extremes, on both precisions of the reference and now and then on the device."""
    table = list(ranges())
    for n in range(1500 if attack.thorough else 150):
        scene = random.choice(list(SMALL))
        keys = [row for row in table if any(row[0].startswith(p) for p, s in SCENES.items() if s == scene or p in ("simulation.", "contact."))]
        words = ["run", scene, *SMALL[scene], "--set", f"simulation.integrator={random.choice(METHODS)}", "--steps", "5"]
        for path, vector, least, largest, positive in random.sample(keys, random.randrange(1, 6)):
            def one():
                return random.choice(values(least, largest, positive)) * random.choice((1.0, 1.0, random.random()))
            words += ["--set", f"{path}=[" + ", ".join(repr(one()) for _ in range(vector)) + "]" if vector else f"{path}={one()!r}"]
        words += ["--backend", "gpu"] if n % 8 == 0 else ["--backend", "reference", "--precision", random.choice(("single", "double"))]
        look(attack, words, " ".join(words), (OK, USAGE, SCENE, DIVERGED))


def known(attack):
    """What once came out as NaN with exit 0, or was refused late."""
    implicit = ["--set", "simulation.integrator=implicit-euler", "--steps", "20"]
    for backend in ("reference", "gpu"):
        for extra in (["cube-plane", "--set", "cube[0].particle-mass=1.9e-38", "--set", "contact.friction=96052"],
                      ["cube-and-balls", "--set", "ball[0].radius=1.9e-38", "--set", "contact.friction=9657"],
                      ["cube-and-balls", "--set", "cube[0].structural.stiffness=1.2e8", "--set", "ball[0].mass=1.5e-3"]):
            look(attack, ["run", *extra, *implicit, "--backend", backend], f"{extra} on {backend}")
    far = ["penalty", *SMALL["penalty"], "--set", "launcher[0].interval=1e6", "--set", "simulation.timestep=1e-14", "--backend", "reference"]
    look(attack, ["run", *far, "--steps", "3"], "a launcher beyond every step")
    for count in (10**7, 10**15):
        done = attack.run("scene", "check", "penalty", "--set", f"launcher[0].count={count}", timeout=60)
        attack.judge(done, [OK, SCENE], f"a launcher of {count} balls")
    for size in ("512", "400"):
        done = attack.run("scene", "show", "cube-plane", "--set", f"cube[0].particles-per-edge={size}", timeout=20)
        attack.judge(done, [OK, SCENE], f"a cube of {size}³")
    huge = write(attack.path("huge.toml"), b"schema = 1\n" + b"# comment\n" * 8_000_000)
    attack.judge(attack.run("scene", "show", huge, timeout=60), [SCENE, 6], "80 MB of comments")
    many = write(attack.path("many.toml"), b"schema = 1\n" + b"[[terrain]]\nshape = \"plane\"\n" * 5000)
    attack.judge(attack.run("scene", "check", many, timeout=60), [OK, SCENE], "5000 planes")


main({f.__name__: f for f in (one_at_a_time, several_at_once, known)})
