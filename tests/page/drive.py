"""drive.py BROWSER JOBS: opens pages in chromium or firefox, saves images of them, and tries keys, mouse, fingers and buttons.
JOBS is JSON: a list of {page, time, image, touch}: the page's file, the moment [s], the PNG file to write, and whether
everything that a reader can do is tried. Exit code 1, with a line for each fault, also where that browser is not installed."""
import base64
import json
import sys

import browser

SIZE = (640, 360)
faults = []


def require(holds, what):
    if not holds:
        faults.append(what)


def near(a, b):
    return abs(a - b) < 1e-6


def fingers(b, x, y):
    """Fingers and the wheel about the middle of the image, by what becomes of the camera."""
    height = b.call("return document.getElementById('view').clientHeight")

    def camera(act, *what):
        b.call("aspic.camera.reset()")
        act(*what)
        # A browser may hand over what it was told in its next frame.
        b.call("await new Promise((go) => requestAnimationFrame(() => setTimeout(go, 100)))")
        return b.call("const { azimuth, elevation, distance, target } = aspic.camera; return [azimuth, elevation, distance, ...target]")

    def require_near(found, wanted, what, slack=1e-6):
        require(all(abs(a - b) <= slack for a, b in zip(found, wanted)), f"{what}: the camera is {found}, not {wanted}")

    still = camera(lambda: None)
    turned = [still[0] - 4 * 60 / height, still[1] + 4 * 24 / height, *still[2:]]
    require_near(camera(b.touch, [((x, y), (x + 60, y + 24))]), turned, "one finger", 4 * 2 / height)
    for name, from_, to in ("fingers that part", 30, 60), ("fingers that close", 60, 30):
        found = camera(b.touch, [((x - from_, y), (x - to, y)), ((x + from_, y), (x + to, y))])
        require_near(found, [*still[:2], still[2] * from_ / to, *still[3:]], name, 0.04 * still[2])
        require(abs(found[0] - still[0]) < 1e-9 and abs(found[1] - still[1]) < 1e-9, f"{name} turn the camera")
    moved = camera(b.touch, [((x - 30, y), (x - 30, y + 40)), ((x + 30, y), (x + 30, y + 40))])
    require(abs(moved[2] / still[2] - 1) < 0.1 and moved[4] > still[4] + 0.02 * still[2] and abs(moved[0] - still[0]) < 1e-9, f"two fingers moved down: {moved}")
    for down, sign in (240, 1), (-240, -1):
        found = camera(b.wheel, (x, y), down)
        require(sign * (found[2] - still[2]) > 0.05 * still[2], f"the wheel by {down} leaves {found[2]} of {still[2]} m")
        require_near([*found[:2], *found[3:]], [*still[:2], *still[3:]], "the wheel")
    b.key("r")


def touch(b):
    """Keys, mouse, fingers and buttons as a reader uses them."""
    get = b.call
    times = get("return aspic.recording.times")
    now = lambda: get("return aspic.player.time")
    image = lambda: get("return aspic.image(160, 90)")
    get("aspic.player.seek(0); document.activeElement.blur(); aspic.changed()")
    b.key("ArrowRight")
    require(near(now(), times[1]), "→ does not go to the next image")
    b.key("ArrowLeft")
    require(near(now(), times[0]), "← does not go to the image before")
    b.key("End")
    require(near(now(), times[-1]), "End does not go to the end")
    b.key("Home")
    require(near(now(), times[0]), "Home does not go to the start")
    b.key(" ")
    require(get("return aspic.player.playing"), "Space does not play")
    get("for (let i = 0; i < 200 && aspic.player.time === aspic.recording.start; ++i) await new Promise((go) => setTimeout(go, 50))")
    require(now() > times[0], "a run that plays does not go on")
    b.key(" ")
    require(not get("return aspic.player.playing"), "Space does not pause")
    b.key("l")
    require(get("return aspic.player.loop && document.getElementById('loop').click() === undefined && !aspic.player.loop"),
            "L and its button do not switch the loop")
    b.key("[")
    require(near(get("return aspic.player.speed"), 0.5), "[ does not make it slower")
    b.key("]")

    # The bar, by its own keys, and the plot, by the mouse.
    get("const bar = document.getElementById('scrub'); bar.value = 0; bar.dispatchEvent(new Event('input')); bar.focus()")
    b.key("ArrowRight")
    require(near(now(), times[1]), "the bar's key does not go to the next image")
    x, y, w = get("const r = document.getElementById('plot').getBoundingClientRect(); return [r.x, r.y + r.height / 2, r.width]")
    b.drag((x + 0.25 * w, y), (x + 0.5 * w, y))
    require(abs(now() - 0.5 * (times[0] + times[-1])) < 0.02 * times[-1], f"the plot's middle is {now()} s")

    # What is shown.
    get("document.activeElement.blur()")
    before = image()
    for key, color in ["2", "strain"], ["3", "signed-strain"], ["4", "speed"], ["5", "force"], ["6", "energy"]:
        b.key(key)
        require(get("return aspic.look.color") == color, f"{key} does not show {color}")
        require(not get("return document.getElementById('legend').hidden"), f"{color} has no legend")
        require(image() != before, f"{color} looks like material")
    legend = lambda: get("const l = document.getElementById('legend'); return l.hidden ? '' : l.textContent")
    b.key("7")
    require(get("return aspic.look.color") == "type" and image() != before, "7 does not show types")
    require(legend() == "", "types have a legend where no spring is drawn")
    get("aspic.setLook('shear', true)")
    require(legend() == "springsshear", f"the legend of shear springs is {legend()}")
    get("aspic.setLook('shear', false)")
    b.key("1")
    require(image() == before, "material does not come back")
    axes = lambda: get("await new Promise((go) => requestAnimationFrame(() => setTimeout(go, 50)));"
                       "const a = document.getElementById('axes-image'); return a.getBoundingClientRect().width && "
                       "Object.fromEntries([...a.querySelectorAll('text')].map((t) => [t.textContent, [+t.getAttribute('x'), +t.getAttribute('y')]]))")
    require(axes() == 0, "axes are drawn from the start")
    b.key("x")
    seen = axes()
    require(sorted(seen) == ["x", "y", "z"] and seen["x"][0] > 1 and seen["y"][1] < -2 and seen["z"][0] < 0, f"axes are seen as {seen}")
    get("aspic.camera.orbit(Math.PI, 0); aspic.changed()")
    turned = axes()
    require(abs(turned["x"][0] + seen["x"][0]) < 1e-3 and abs(turned["y"][1] - seen["y"][1]) < 1e-3, f"turned, axes are seen as {turned}")
    get("aspic.camera.reset()")
    b.key("x")
    require(axes() == 0, "X does not take the axes away")
    for key, what in ["k", "springs"], ["p", "particles"]:
        b.key(key)
        require(image() != before, f"{key} shows no {what}")
        get("for (const what of ['structural', 'shear', 'bending', 'particles']) aspic.setLook(what, false)")
    require(image() == before, "springs and particles do not go")
    get("document.getElementById('terrain').click()")
    require(image() != before, "terrain does not go")
    get("document.getElementById('terrain').click()")
    x, y = get("const r = document.getElementById('view').getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]")
    b.drag((x, y), (x + 60, y + 20))
    require(image() != before, "a drag does not turn the camera")
    get("document.activeElement.blur()")
    b.key("r")
    require(image() == before, "R does not bring the view back")
    b.key("+")
    require(image() != before, "+ does not zoom")
    b.key("r")
    fingers(b, x, y)
    require(image() == before, "R does not bring the view back after fingers")

    # The rest of the page.
    dark = lambda: get("return getComputedStyle(document.body).backgroundColor")
    first = dark()
    b.key("t")
    require(dark() != first, "T does not change light and dark")
    b.key("t")
    b.key("?")
    require(get("return document.getElementById('keys').open"), "? does not show the keys")
    get("document.getElementById('keys').close()")
    get("document.getElementById('copy').click(); await new Promise((go) => setTimeout(go, 100))")
    require("copied" in get("return document.getElementById('said').textContent"), "nothing says that the command is copied")
    nameless = get("return [...document.querySelectorAll('button, select, input')].filter((e) => "
                   "!e.textContent.trim() && !e.labels?.length && !e.ariaLabel).map((e) => e.id)")
    require(nameless == [], f"without a name: {nameless}")
    require(get("return document.documentElement.scrollWidth <= innerWidth"), "the page is wider than the window")
    wrong = get("""
      const run = aspic.recording.runs[0], springs = aspic.bodies[0].springs, x = run.positions[0], v = new Float32Array(x.length);
      return Math.max(...Array.from(springs.a.keys()).map((s) => springs.value("strain", s, x, v)))""")
    require(wrong < 1e-3, f"springs at rest are strained by {wrong}")


def main():
    kind = {"chromium": browser.Chromium, "firefox": browser.Firefox}[sys.argv[1]]
    b = browser.start(kind)
    if b is None:
        print(f"{kind.name} is not installed")
        return 1
    try:
        for job in json.loads(sys.argv[2]):
            b.open(job["page"], 800, 600)
            where = job["page"].rsplit("/", 1)[-1]
            notice = b.call("return document.getElementById('notice').textContent")
            require(notice == "", f"{where}: {notice}")
            url = b.call(f"aspic.player.seek({job['time']}); return aspic.image({SIZE[0]}, {SIZE[1]})")
            with open(job["image"], "wb") as file:
                file.write(base64.b64decode(url.split(",")[1]))
            if job.get("touch"):
                touch(b)
            for error in b.errors:
                require(False, f"{where}: {error}")
            for request in b.requests:
                require(request.startswith("file:") and request.split("#")[0].endswith(where), f"{where}: asked for {request}")
            if job.get("touch"):
                for dark, width, phone in (True, 1280, False), (False, 390, True):
                    b.open(job["page"], width, 800, dark=dark, phone=phone)
                    require(b.call("return document.documentElement.scrollWidth <= innerWidth"), f"{where}: wider than {width}")
                    shade = b.call("return getComputedStyle(document.body).backgroundColor.match(/\\d+/g).map(Number)")
                    require((max(shade) < 128) == dark, f"{where}: {shade} where dark is {dark}")
    except browser.Failure as failure:
        require(False, str(failure))
    finally:
        b.close()
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
