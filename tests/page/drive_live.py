"""drive_live.py BROWSER JOB: pages that simulate, in chromium or firefox. JOB is JSON, one of
{page, runs, results}: computes runs [{scene, steps}] with the module of the page, and writes [[step, hash]] to `results`;
{pages, touch}: opens pages, whose bits must be those of the machine that made them, and in the first tries what a reader can do.
Exit code 1, with a line for each fault, also where that browser is not installed."""
import json
import sys
import time

import browser

LIMIT = 300.0
faults = []


def require(holds, what):
    if not holds:
        faults.append(what)
    return holds


def wait(b, condition, what):
    end = time.monotonic() + LIMIT
    while not b.call(f"return {condition}"):
        if time.monotonic() > end:
            raise browser.Failure(f"never: {what}")
        time.sleep(0.05)


COMPUTE = """
  const text = (id) => document.getElementById(id).textContent;
  const worker = new Worker(URL.createObjectURL(new Blob([text('worker')]))), last = {};
  worker.postMessage({ command: 'load', deflated: bytesOf(text('module')) });
  window.computed = (text, steps) => new Promise((go) => {
    worker.onmessage = ({ data }) => {
      if (data.hash) last.end = [data.step, data.hash];
      if (data.failed) go([-1, data.failed]);
      if (data.done || data.diverged) go(last.end);
    };
    worker.postMessage({ command: 'create', text, plan: [steps], generation: 1 });
  });"""


def compute(b, job):
    b.open(job["page"])
    b.call(COMPUTE)
    with open(job["runs"]) as file:
        runs = json.load(file)
    results = [b.call(f"return computed({json.dumps(run['scene'])}, {run['steps']})") for run in runs]
    with open(job["results"], "w") as file:
        json.dump(results, file)


def touch(b, where):
    """What a reader changes."""
    get = b.call
    say = lambda id: get(f"aspic.show(); return document.getElementById('{id}').textContent")
    done = lambda: wait(b, "aspic.recording.done && aspic.panel.pending.size === 0", "the run's end")
    control = lambda path, kind: (f"[...document.querySelectorAll('.control')].find((c) => c.title === aspic.recording.live.controls"
                                  f".flatMap((g) => g.rows).find((r) => r.path === '{path}').meaning).querySelector('{kind}')")

    def change(path, kind, value, event):
        get("aspic.player.playing = false; aspic.player.seek(aspic.recording.times[1])")
        get(f"const field = {control(path, kind)}; field.value = {json.dumps(value)}; field.dispatchEvent(new Event('{event}', {{ bubbles: true }}));"
            "await new Promise((go) => requestAnimationFrame(() => setTimeout(go, 50)))")
        done()

    height = lambda image: get(f"const x = aspic.recording.run.positions[{image}]; let sum = 0; for (let i = 1; i < x.length; i += 3) sum += x[i]; return sum / (x.length / 3)")
    count = get("return aspic.recording.read")
    middle, falling, last = count // 2, 4 * count // 5, count - 1
    at_middle, at_falling, at_last = height(middle), height(falling), height(last)
    hash_there = get("return aspic.recording.machine.hash")

    # Half of gravity from the middle on: what was before stays, and the cube falls more slowly.
    get(f"aspic.player.playing = false; aspic.player.seek(aspic.recording.times[{middle}]); aspic.changed()")
    field = "[...document.querySelectorAll('.control')].find((c) => c.textContent.startsWith('gravity y')).querySelector('input[type=text]')"
    get(f"const field = {field}; field.value = '-4.9'; field.dispatchEvent(new Event('change')); await new Promise((go) => requestAnimationFrame(() => setTimeout(go, 50)))")
    done()
    require(get("return aspic.recording.read") == count, f"{where}: with other gravity there are other images")
    require(height(middle) == at_middle, f"{where}: a change has changed the past")
    require(height(falling) > at_falling + 0.2, f"{where}: half of gravity changes nothing")
    require(say("bits").startswith("You changed values at"), f"{where}: a changed run says {say('bits')}")
    require(say("verdict") == "", f"{where}: a changed run has the verdict {say('verdict')}")
    get("document.getElementById('restart').click()")
    done()
    require(height(middle) > at_middle + 0.01, f"{where}: a restart does not keep values")

    # A slider, by the browser's own keys.
    get(f"const slider = {control('cube[0].structural.stiffness', 'input[type=range]')}; slider.closest('details').open = true; slider.scrollIntoView(); slider.focus()")
    before = get("return aspic.recording.values.get('cube[0].structural.stiffness')")
    b.key("ArrowRight")
    get("await new Promise((go) => requestAnimationFrame(() => setTimeout(go, 100)))")
    done()
    after = get("return aspic.recording.values.get('cube[0].structural.stiffness')")
    require(after > before, f"{where}: the slider's key leaves {before} at {after}")
    require(abs(get("return aspic.recording.run.facts.classes[0].k") - after) < 1e-9, f"{where}: the springs do not have the slider's stiffness")
    get("document.activeElement.blur()")

    # What cannot be is refused, and letters typed are no keys of the page.
    change("contact.friction", "input[type=text]", "-3", "change")
    require("friction" in say("refused"), f"{where}: friction −3 is not refused: {say('refused')}")
    get(f"const field = {control('contact.friction', 'input[type=text]')}; field.closest('details').open = true; field.focus()")
    b.key("2")
    require(get("return aspic.look.color") == "material", f"{where}: a digit typed into a field changes colors")
    get("document.activeElement.blur()")

    change("simulation.timestep", "input[type=text]", "1e-60", "change")
    require("zero in single precision" in say("refused"), f"{where}: a time step of 1e-60 s is not refused: {say('refused')}")
    require(get("return aspic.recording.values.get('simulation.timestep')") == 0.001, f"{where}: the refused time step stays")

    # A time step that explodes says so, and a method that stands it does not.
    change("simulation.timestep", "input[type=text]", "0.05", "change")
    get("aspic.player.seek(Infinity)")
    require("diverged in step" in say("notice"), f"{where}: what diverges says {say('notice')}")
    change("simulation.integrator", "select", "implicit-euler", "change")
    require(not get("return aspic.recording.diverged"), f"{where}: implicit Euler diverges")
    require(say("notice") == "", f"{where}: the notice of a divergence stays: {say('notice')}")

    # Back to the scene.
    b.key("n")
    done()
    get("document.getElementById('restore').click()")
    wait(b, "aspic.recording.done && !aspic.recording.changed", "the scene again")
    require(say("verdict") == "the same", f"{where}: the scene restored is {say('verdict')}, {say('bits')}")
    require(get("return aspic.recording.run.end.hash") == hash_there, f"{where}: the scene restored has another hash")
    require(abs(height(last) - at_last) < 1e-12, f"{where}: the scene restored moves otherwise")


def actuated(b, where):
    """The color of springs that follow signals, of which other runs say nothing."""
    if not b.call("return aspic.recording.run.facts.actuated.length"):
        require(not b.call("return aspic.offers('actuation')"), f"{where}: has the color actuation without an actuator")
        return
    image = lambda: b.call("return aspic.image(160, 90)")
    b.call("aspic.player.playing = false; aspic.player.seek(Infinity); aspic.setColor('material')")
    before = image()
    b.call("aspic.setColor('actuation')")
    require(not b.call("return document.getElementById('legend').hidden"), f"{where}: actuation has no legend")
    require(image() != before, f"{where}: actuation looks like material")
    images, most = b.call("const { changes } = aspic.recording.run; return [changes.length, Math.max(...changes.at(-1).map(Math.abs))]")
    require(images == b.call("return aspic.recording.read"), f"{where}: {images} images say how far rest lengths are changed")
    require(0.001 < most < 1, f"{where}: rest lengths are changed by {most} at most")


def inputs(b, where):
    """Sliders of the inputs that actuators follow."""
    rows = b.call("return aspic.recording.inputs.map((row) => [row.path, row.label])")
    for path, label in rows:
        most = lambda: b.call("return Math.max(...aspic.recording.run.changes.at(-1).map(Math.abs))")
        require(most() == 0, f"{where}: rest lengths follow {label} before it is set")
        b.call("aspic.player.playing = false; aspic.player.seek(aspic.recording.times[1])")
        b.call(f"aspic.panel.set({json.dumps(path)}, 0.5); await new Promise((go) => requestAnimationFrame(() => setTimeout(go, 50)))")
        wait(b, "aspic.recording.done && aspic.panel.pending.size === 0", f"the end with {label}")
        require(most() > 0.001, f"{where}: rest lengths do not follow {label}")
        b.call("document.getElementById('restore').click()")
        wait(b, "aspic.recording.done && !aspic.recording.changed", "the scene again")
        require(most() == 0, f"{where}: the scene restored keeps {label}")
    return [label for _, label in rows]


def open_pages(b, job):
    for number, page in enumerate(job["pages"]):
        where = page.rsplit("/", 1)[-1]
        b.open(page)
        wait(b, "aspic.recording.done", f"the end of {where}")
        said = b.call("aspic.show(); return ['notice', 'verdict', 'bits'].map((id) => document.getElementById(id).textContent)")
        diverged = b.call("return aspic.recording.machine.diverged ?? ''")
        require(diverged == b.call("return aspic.recording.diverged ?? ''"), f"{where}: another divergence")
        sheets = b.call("return aspic.recording.live.sheets")
        require((said[1] == "the same" and "in all" in said[2]) or (sheets and "denormal" in said[2]), f"{where}: {said}")
        wait(b, "aspic.stats.images > 0", f"an image of {where}")
        print(f"{b.name} {where}: first image after {b.call('return aspic.stats.firstImage'):.0f} ms, "
              f"{b.call('return aspic.recording.rate'):.0f} steps a second")
        if job.get("inputs"):
            require(inputs(b, where) == job["inputs"], f"{where}: has other sliders of inputs than {job['inputs']}")
            headings = b.call("return [...document.querySelectorAll('#controls summary')].map((s) => s.textContent)")
            require({"inputs", "material muscle", "actuator legs"} <= set(headings), f"{where}: has the headings {headings}")
        else:
            actuated(b, where)
        if number == 0 and job.get("touch"):
            touch(b, where)
            nameless = b.call("return [...document.querySelectorAll('button, select, input')].filter((e) => "
                              "!e.textContent.trim() && !e.labels?.length && !e.ariaLabel).map((e) => e.id)")
            require(nameless == [], f"{where}: without a name: {nameless}")
            for error in b.errors:
                require(False, f"{where}: {error}")
            for width, phone in (1280, False), (390, True):
                b.open(page, width, 844, phone=phone)
                require(b.call("return document.documentElement.scrollWidth <= innerWidth"), f"{where}: wider than {width}")
        for error in b.errors:
            require(False, f"{where}: {error}")
        for request in b.requests:
            own = request.startswith("file:") and request.split("#")[0].endswith(where)
            require(own or request.startswith("blob:"), f"{where}: asked for {request}")


def main():
    kind = {"chromium": browser.Chromium, "firefox": browser.Firefox}[sys.argv[1]]
    b = browser.start(kind)
    if b is None:
        print(f"{kind.name} is not installed")
        return 1
    job = json.loads(sys.argv[2])
    try:
        compute(b, job) if "runs" in job else open_pages(b, job)
    except browser.Failure as failure:
        require(False, str(failure))
    finally:
        b.close()
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
