"""Faults by count: every file operation refused or the last one before a kill, memory that runs out at every place where a
run allocates, ffmpeg dying at every frame, a device lost at every pass. What must come of each: a named error, nothing half
written, earlier files as they were."""
import os
import re

from attack import DEVICE, IO, OK, SCENE, TINY, all_files, hash_in, main, read, write

SERIES = ["--series", "series.csv", "--every", "3", "--state", "end.csv", "--checkpoint", "end.aspic"]
REFERENCE = ["run", "cube-plane", "--backend", "reference", *TINY, "--steps", "12", *SERIES]
PAGED = [*REFERENCE, "--html", "run.html"]


def faulty(attack, order, words, directory, **more):
    """A run with one fault. Returns it, the name of what was struck, and the counts of chances."""
    log = attack.path("log")
    if os.path.exists(log):
        os.remove(log)
    env = {"LD_PRELOAD": attack.shim, "ASPIC_FAULT_LOG": log, **more.pop("env", {})}
    if order:
        env["ASPIC_FAULT"] = order
    done = attack.run(*words, env=env, cwd=directory, **more)
    text = read(log).decode() if os.path.exists(log) else ""
    struck = re.search(r"struck (.+)", text)
    counts = {kind: int(n) for kind, n in re.findall(r"(\w+) (\d+)", text.replace("struck", ""))}
    return done, struck.group(1) if struck else None, counts


class Bench:
    """A command, what it writes when nothing goes wrong, and what was there before."""

    def __init__(self, attack, words, before):
        self.attack, self.words, self.before = attack, words, before
        self.struck = []
        self.lay_out()
        done, _, self.counts = faulty(attack, None, words, self.directory)
        attack.judge(done, [OK], "without a fault")
        self.complete = self.contents()
        self.hash = hash_in(done)

    def contents(self):
        return {os.path.relpath(p, self.directory): read(p) for p in all_files(self.directory)}

    def lay_out(self):
        # A directory of its own for each run: the ffmpeg of one that was killed may still be at work.
        self.directory = self.attack.fresh()
        for name, content in self.before.items():
            write(os.path.join(self.directory, name), content)

    def strike(self, order, codes, killed=False, unreached=None):
        """One fault, and everything that must hold after it. `unreached`: what is allowed where it found no chance."""
        attack = self.attack
        self.lay_out()
        done, struck, _ = faulty(attack, order, self.words, self.directory)
        note = f"{order} ({struck})"
        if struck is None and unreached:
            codes = unreached
        if killed:
            attack.require(struck is None or done.code == -9, f"{note}: {done}, not killed")
        else:
            attack.judge(done, codes, note)
            if "alloc" in order or "own" in order:
                attack.require(done.code == OK or b"memory" in done.err, f"{note}: the wrong thing is blamed: {done}")
        for name, content in self.contents().items():
            temporary = os.path.basename(name).startswith(".aspic-")
            # A file that could not be removed, or whose owner was killed, is all that may stay.
            if temporary:
                attack.require(killed or struck == "unlink", f"{note}: left {name}")
                continue
            whole = self.complete.get(name)
            same = content in (self.before.get(name), whole)
            # The seconds that a run took are not in any of these files; videos differ in nothing either.
            attack.require(same, f"{note}: {name} is neither as before nor whole ({len(content)} of {len(whole or b'')} bytes)")
        for name in self.before:
            attack.require(os.path.exists(os.path.join(self.directory, name)), f"{note}: {name} is gone")
        if not killed and struck != "unlink":
            self.struck.append((note, self.directory))
        if done.code == OK and not killed:
            now = {n: c for n, c in self.contents().items() if not os.path.basename(n).startswith(".aspic-")}
            attack.require(now == self.complete, f"{note}: exit 0, but not every file is there and whole")
        return struck


def nothing_comes_later(bench):
    """An ffmpeg that outlived its run would write its file after all."""
    for note, directory in bench.struck:
        bench.attack.leaves_nothing(directory, f"{note}, later")


def old_files(attack):
    """Earlier outputs, of another run, with a checkpoint to resume from."""
    directory = attack.fresh()
    words = [w if w != "12" else "5" for w in PAGED]
    attack.judge(attack.run(*words, cwd=directory), [OK], "earlier run")
    return {os.path.basename(p): read(p) for p in all_files(directory)}


def resumes(attack, bench):
    """Whatever checkpoint is there goes on to the same end."""
    checkpoint = os.path.join(bench.directory, "end.aspic")
    if os.path.exists(checkpoint):
        done = attack.run("run", "--resume", checkpoint, "--steps", "12", "--backend", "reference")
        if attack.judge(done, [OK], "resuming"):
            attack.require(hash_in(done) == bench.hash, f"resumed to {hash_in(done)}, not {bench.hash}")


def benches(attack):
    """The same run into an empty directory, over earlier files, and from a checkpoint."""
    earlier = old_files(attack)
    resumed = ["run", "--resume", "old.aspic", "--backend", "reference", "--steps", "12", *SERIES, "--html", "run.html"]
    return [Bench(attack, PAGED, {}), Bench(attack, [*PAGED, "--force"], earlier),
            Bench(attack, resumed, {"old.aspic": earlier["end.aspic"]})]


def files(attack):
    """Each file operation fails once, the disk is full from each on, writes are short."""
    for bench in benches(attack):
        for n in range(1, bench.counts["file"] + 1):
            bench.strike(f"file:{n}", [OK, IO])
            bench.strike(f"file:{n}:EMFILE", [OK, IO])
            resumes(attack, bench)
        for n in range(1, bench.counts["disk"] + 1):
            bench.strike(f"disk:{n}", [OK, IO])
            bench.strike(f"disk:{n}+", [OK, IO])
            resumes(attack, bench)
        bench.strike("short:1", [OK])
        attack.require(bench.contents() == bench.complete, "short writes: not every file is whole")
    other = attack.fresh()
    scene = write(os.path.join(other, "scene.toml"), attack.run("scene", "show", "cube-plane", *TINY).out)
    for words in (["scene", "check", scene], ["scene", "show", scene]):
        _, _, counts = faulty(attack, None, words, other)
        for n in range(1, counts["file"] + 1):
            attack.judge(faulty(attack, f"file:{n}", words, other)[0], [OK, IO], f"file:{n} of {words[:2]}")


def file_kills(attack):
    """SIGKILL before each file operation, and at its end."""
    for bench in benches(attack):
        for n in range(1, bench.counts["file"] + 2):
            bench.strike(f"file:{n}:kill", [], killed=True)
            resumes(attack, bench)


def allocations(attack):
    """Memory refused once, and from there on for good, at each place where a run allocates."""
    earlier = old_files(attack)
    bench = Bench(attack, [*REFERENCE, "--force"], earlier)
    total, stride = bench.counts["alloc"], 1 if attack.thorough else 3
    for n in range(1, total + 1, stride):
        bench.strike(f"alloc:{n}", [OK, SCENE, IO])
    for n in range(2, total + 1, 2 * stride):
        # The last ones are those of stdio's buffer and of the process's end, which do without.
        bench.strike(f"alloc:{n}+", [SCENE, IO] if n < total - 20 else [OK, SCENE, IO])
    # A page allocates thousands of times, all alike.
    bench = Bench(attack, [*PAGED, "--force"], earlier)
    for n in range(1, bench.counts["alloc"] + 1, 1 if attack.thorough else max(1, bench.counts["alloc"] // 150)):
        bench.strike(f"alloc:{n}", [OK, SCENE, IO])
    directory = attack.fresh()
    scene = write(os.path.join(directory, "scene.toml"), attack.run("scene", "show", "goal-net").out)
    # scene check asks the device how large a cube may be: drivers are left out, as below.
    commands = [("own", ["scene", "check", scene]), ("alloc", ["scene", "show", scene]),
                ("alloc", ["compare", scene, "--backends", "reference,reference:double", "--steps", "3"]),
                ("alloc", ["run", "cube-plane", *TINY, "--steps", "3", "--json", "--backend", "reference"]),
                ("alloc", ["scene", "list"]), ("alloc", ["run", "nowhere"])]
    for kind, words in commands:
        _, _, counts = faulty(attack, None, words, directory)
        step = 1 if attack.thorough else max(1, counts[kind] // 60)
        last = range(max(1, counts[kind] - 100), counts[kind] + 1)  # the report, which holds everything at once
        for n in sorted({*range(1, counts[kind] + 1, step), *last}):
            attack.judge(faulty(attack, f"{kind}:{n}", words, directory)[0], [OK, 1, 2, 3, IO], f"{kind}:{n} of {words}")


GPU = ["run", "cube-plane", "--backend", "gpu", *TINY, "--steps", "12", *SERIES]
VIDEO = ["run", "cube-plane", "--backend", "gpu", *TINY, "--set", "simulation.timestep=0.002", "--duration", "0.1", "--fps", "60",
        "--video", "video.mp4", "--size", "64x64", "--text", "off", "--frames", "images"]


def device_allocations(attack):
    """The same for what the program itself allocates with a device and with videos; drivers are not asked."""
    for words, most in ((GPU, 40), (VIDEO, 16)):
        bench = Bench(attack, words, {})
        stride = 1 if attack.thorough else max(1, bench.counts["own"] // most)
        for n in range(1, bench.counts["own"] + 1, stride):
            bench.strike(f"own:{n}", [OK, SCENE, DEVICE, IO])
        nothing_comes_later(bench)


def videos(attack):
    """A full disk and failing operations while a video is made."""
    bench = Bench(attack, VIDEO, {})
    for n in range(1, bench.counts["file"] + 1, 1 if attack.thorough else 4):
        bench.strike(f"file:{n}", [OK, IO])
    for n in range(1, bench.counts["disk"] + 1, 1 if attack.thorough else 5):
        bench.strike(f"disk:{n}+", [OK, IO])
    for n in range(1, bench.counts["file"] + 1, 1 if attack.thorough else 9):
        bench.strike(f"file:{n}:kill", [], killed=True)
    bench.strike("short:1", [OK])
    nothing_comes_later(bench)


def ffmpeg(attack):
    """An ffmpeg that dies at each frame: by itself, by a signal, silently, after having written a file."""
    frame = 3 * 64 * 64
    directory = attack.fresh()
    tool = os.path.join(directory, "bin")
    os.mkdir(tool)
    endings = ["echo 'no space left' >&2; exit 1", "kill -9 $$", "exit 1", "exit 0"]
    bench = Bench(attack, VIDEO, {})
    frames = len([n for n in bench.complete if n.startswith("images/")])
    for count in range(frames + 1):
        for ending in endings if attack.thorough or count in (0, 1, frames) else endings[:1]:
            write(os.path.join(tool, "ffmpeg"),
                  f"#!/bin/sh\nfor last; do :; done\nhead -c {count * frame} > /dev/null\necho half > \"${{last#file:}}\"\n{ending}\n")
            os.chmod(os.path.join(tool, "ffmpeg"), 0o755)
            there = attack.fresh()
            write(os.path.join(there, "earlier.mp4"), "earlier")
            done = attack.run(*VIDEO, env={"PATH": f"{tool}:/usr/bin:/bin"}, cwd=there, timeout=120)
            note = f"ffmpeg after {count} frames: {ending}"
            attack.judge(done, [IO], note)
            attack.leaves_nothing(there, note)
            if done.code != OK:
                attack.require(not os.path.exists(os.path.join(there, "video.mp4")), f"{note}: a video is there")
            attack.require(read(os.path.join(there, "earlier.mp4")) == b"earlier", f"{note}: an earlier video has changed")
            images = {os.path.relpath(p, there): read(p) for p in all_files(os.path.join(there, "images"))}
            attack.require(images == {n: c for n, c in bench.complete.items() if n.startswith("images/")}, f"{note}: {sorted(images)}")


def device(attack):
    """A device lost at every pass: dispatches, draws and read-backs."""
    implicit = ["run", "cube-plane", "--backend", "gpu", *TINY, "--set", "simulation.integrator=implicit-euler", "--steps", "3", *SERIES]
    balls = ["run", "cube-and-balls", "--backend", "gpu", *TINY, "--steps", "4", *SERIES]
    per_spring = [*GPU, "--force-path", "per-spring"]
    for words, most in ((GPU, 25), (per_spring, 20), (implicit, 30), (balls, 30), (VIDEO, 12)):
        bench = Bench(attack, words, {})
        stride = 1 if attack.thorough else max(1, bench.counts["pass"] // most)
        # The last read-backs come after the last look at the device that steps need.
        chances = sorted({*range(1, bench.counts["pass"] + 1, stride), *range(max(1, bench.counts["pass"] - 3), bench.counts["pass"] + 1)})
        missed = sum(bench.strike(f"pass:{n}", [DEVICE], unreached=[OK]) is None for n in chances)
        # How often a run looks at the device depends on how fast it is: the last chances may not come.
        attack.require(missed <= len(chances) // 5, f"{missed} of {len(chances)} passes were never reached")


main({f.__name__: f for f in (files, file_kills, allocations, device_allocations, videos, ffmpeg, device)})
