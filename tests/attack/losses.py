"""What a run of hours must not be lost by: a link, a closed terminal, an encoder that dies or hangs, a reader that does not come; and
readers given what has no end. Each run here loses at most the one output that was struck."""
import os
import pty
import shutil
import signal
import stat
import subprocess
import time

from attack import DEVICE, INTERRUPTED, IO, OK, SCENE, TINY, USAGE, all_files, hash_in, main, read, write

RUN = ["run", "cube-plane", *TINY, "--backend", "reference", "--steps", "12"]
LONG = ["run", "cube-plane", *TINY, "--backend", "reference", "--steps", "1000000000"]
FILES = ["--series", "series.csv", "--state", "end.csv", "--checkpoint", "end.aspic"]
NAMES = ("end.aspic", "end.csv", "series.csv")
IMAGES = ["--size", "64x64", "--text", "off", "--fps", "60"]
SIDE = 64
FRAME = 3 * SIDE * SIDE


def names(directory):
    return sorted(os.path.relpath(p, directory) for p in all_files(directory))


def start(attack, words, directory, env=None, **more):
    attack.runs += 1
    environment = {k: v for k, v in os.environ.items() if k != "LD_PRELOAD"}
    return subprocess.Popen([attack.program, *words], cwd=directory, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            env={**environment, **(env or {})}, **more)


def wait_until(condition, seconds=60):
    end = time.monotonic() + seconds
    while not condition() and time.monotonic() < end:
        time.sleep(0.01)
    return condition()


def end_of(attack, child, note, seconds=60):
    """Its exit code and messages; None if it does not end."""
    started = time.monotonic()
    try:
        _, err = child.communicate(timeout=seconds)
        return child.returncode, err or b"", time.monotonic() - started
    except subprocess.TimeoutExpired:
        child.kill()
        child.communicate()
        attack.blame(f"{note}: did not end within {seconds} s")
        return None, b"", seconds


def handles(child, number):
    """Whether a process has a handler for a signal by now."""
    for line in read(f"/proc/{child.pid}/status").decode().splitlines():
        if line.startswith("SigCgt:"):
            return int(line.split()[1], 16) >> (number - 1) & 1 == 1
    return False


def links(attack):
    """Outputs through links to nothing, to something, into missing directories and in circles."""
    plain = attack.fresh()
    attack.judge(attack.run(*RUN, *FILES, cwd=plain), [OK], "without links")
    options = {"--state": "end.csv", "--series": "series.csv", "--checkpoint": "end.aspic"}
    for option, name in options.items():
        for force in ([], ["--force"]):
            note = f"{option} through a link to nothing {force}"
            there = attack.fresh()
            os.mkdir(os.path.join(there, "disk"))
            os.symlink("second", os.path.join(there, name))
            os.symlink("disk/target", os.path.join(there, "second"))
            attack.judge(attack.run(*RUN, option, name, *force, cwd=there), [OK], note)
            attack.require(os.path.islink(os.path.join(there, name)) and os.path.islink(os.path.join(there, "second")), f"{note}: a link is gone")
            target = os.path.join(there, "disk", "target")
            attack.require(os.path.exists(target) and read(target) == read(os.path.join(plain, name)), f"{note}: the target is not whole")
            attack.leaves_nothing(there, note)
            again = attack.run(*LONG, option, name, cwd=there, timeout=20)
            attack.judge(again, [IO], f"{note}, once more")
        # Refused before the first step: the run would not end within the time.
        for target in ("missing/target", name):
            there = attack.fresh()
            os.symlink(target, os.path.join(there, name))
            for force in ([], ["--force"]):
                attack.judge(attack.run(*LONG, option, name, *force, cwd=there, timeout=20), [IO], f"{option} through a link to {target}")
                attack.require(os.path.islink(os.path.join(there, name)), f"{option}: the link to {target} is gone")
    there = attack.fresh()
    os.symlink("same.csv", os.path.join(there, "link.csv"))
    attack.judge(attack.run(*LONG, "--state", "link.csv", "--series", "same.csv", cwd=there, timeout=20), [USAGE], "two outputs of one name, through a link")
    # States of many steps: what an earlier run left is found before the first step.
    write(os.path.join(there, "end-00000900.csv"), "earlier")
    late = attack.run(*LONG, "--state", "end.csv", "--state-every", "100", cwd=there, timeout=20)
    attack.judge(late, [IO], "a state of a later step is there")
    attack.require(names(there) == ["end-00000900.csv", "link.csv"], f"a state of a later step is there: left {names(there)}")
    video = ["run", "cube-plane", *TINY, "--backend", "reference", "--steps", "40", *IMAGES]
    there = attack.fresh()
    os.mkdir(os.path.join(there, "disk"))
    os.symlink("disk/target.mp4", os.path.join(there, "video.mp4"))
    attack.judge(attack.run(*video, "--video", "video.mp4", cwd=there), [OK], "a video through a link to nothing")
    attack.require(os.path.islink(os.path.join(there, "video.mp4")) and os.path.getsize(os.path.join(there, "disk", "target.mp4")) > 0,
                   "a video through a link to nothing: not there")
    os.symlink("nowhere", os.path.join(there, "images"))
    attack.judge(attack.run(*video, "--frames", "images", "--force", cwd=there), [IO], "images through a link to nothing")
    os.symlink("disk/sweep.csv", os.path.join(there, "sweep.csv"))
    attack.judge(attack.run("sweep", "cube-plane", *TINY, "--steps", "2", "--backend", "reference", "--vary", "contact.friction=0.1,0.2", "--out", "sweep.csv",
                            cwd=there), [OK], "a sweep through a link to nothing")
    attack.require(os.path.islink(os.path.join(there, "sweep.csv")) and os.path.exists(os.path.join(there, "disk", "sweep.csv")),
                   "a sweep through a link to nothing: not there")


def hangups(attack):
    """SIGHUP, once and several times, from a terminal that closes, and ignored under nohup."""
    def complete(directory, note):
        attack.require(names(directory) == sorted(NAMES), f"{note}: left {names(directory)}")
        checkpoint = os.path.join(directory, "end.aspic")
        if os.path.exists(checkpoint):
            done = attack.run("run", "--resume", checkpoint, "--steps", "1", "--backend", "reference")
            attack.judge(done, [OK, USAGE], f"{note}: resuming")  # most are past that step, and say so

    for signals in ([signal.SIGHUP], [signal.SIGHUP] * 5, [signal.SIGHUP, signal.SIGTERM], [signal.SIGTERM, signal.SIGHUP]):
        note = " ".join(signal.Signals(s).name for s in signals)
        there = attack.fresh()
        child = start(attack, [*LONG, *FILES, "--every", "1000"], there)
        attack.require(wait_until(lambda c=child, d=there: handles(c, signal.SIGTERM) and len(names(d)) == 3), f"{note}: it did not begin")
        # Held, so that all arrive before it does anything.
        child.send_signal(signal.SIGSTOP)
        for number in signals:
            child.send_signal(number)
        child.send_signal(signal.SIGCONT)
        code, err, _ = end_of(attack, child, note)
        attack.require(code == INTERRUPTED, f"{note}: ended {code} {err[:300]}")
        complete(there, note)

    there = attack.fresh()
    master, slave = pty.openpty()

    def own_terminal():
        import fcntl
        import termios
        fcntl.ioctl(0, termios.TIOCSCTTY, 0)

    child = subprocess.Popen([attack.program, *LONG, *FILES, "--every", "1000"], cwd=there, stdin=slave, stdout=slave, stderr=slave, start_new_session=True,
                             preexec_fn=own_terminal)
    attack.runs += 1
    os.close(slave)
    wait_until(lambda: handles(child, signal.SIGTERM) and len(names(there)) == 3)
    os.close(master)  # what it says goes nowhere from here on
    code, _, _ = end_of(attack, child, "a terminal that closes")
    attack.require(code in (INTERRUPTED, IO), f"a terminal that closes: ended {code}")
    complete(there, "a terminal that closes")

    there = attack.fresh()
    child = start(attack, [*LONG, *FILES, "--every", "1000"], there, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    wait_until(lambda: handles(child, signal.SIGTERM) and len(names(there)) == 3)
    child.send_signal(signal.SIGHUP)
    time.sleep(0.3)  # it must not end: there is nothing to wait for
    attack.require(child.poll() is None, "under nohup: ended")
    child.send_signal(signal.SIGTERM)
    code, err, _ = end_of(attack, child, "under nohup")
    attack.require(code == INTERRUPTED, f"under nohup: ended {code} {err[:300]}")
    complete(there, "under nohup")


def tool(attack, name, script):
    """A directory with a program of that name."""
    directory = attack.fresh()
    path = write(os.path.join(directory, name), "#!/bin/sh\nfor last; do :; done\nfile=${last#file:}\n" + script + "\n")
    os.chmod(path, 0o755)
    return directory


UNSEEN = ["run", "cube-plane", *TINY, "--backend", "reference", "--set", "simulation.timestep=0.002"]
VIDEO = [*UNSEEN, *IMAGES]
DYING = {
    "dies at once": "exit 1",
    "dies with a message": f"head -c {2 * FRAME} > /dev/null; echo 'no space left' >&2; exit 1",
    "is killed": f"head -c {2 * FRAME} > /dev/null; kill -9 $$",
    "ends silently": f"head -c {FRAME} > /dev/null; echo half > \"$file\"; exit 3",
    "ends well at once": "exit 0",
    "ends well after two images": f"head -c {2 * FRAME} > /dev/null; echo half > \"$file\"; exit 0",
    "reads all and writes nothing": "cat > /dev/null; exit 0",
    "reads all and writes half a header": "cat > /dev/null; printf '\\000\\000\\000\\040ftypisom' > \"$file\"; exit 0",
    "reads all and writes noise": "cat > \"$file\"; exit 0",
    "removes its file": "cat > /dev/null; rm -f \"$file\"; exit 0",
}


def encoders(attack):
    """An ffmpeg that dies, or reports success without a video: the video alone is lost."""
    plain = attack.fresh()
    video = [*VIDEO, "--duration", "0.2"]
    whole = attack.run(*UNSEEN, "--duration", "0.2", *FILES, cwd=plain)
    attack.judge(whole, [OK], "without a video")

    def struck(note, env):
        there = attack.fresh()
        write(os.path.join(there, "video.mp4"), "earlier")
        done = attack.run(*video, *FILES, "--force", "--video", "video.mp4", cwd=there, env=env)
        attack.judge(done, [IO], note)
        attack.require(b"cannot make the video" in done.err and b"All other files of the run are complete." in done.err, f"{note}: says {done}")
        attack.require(hash_in(done) == hash_in(whole), f"{note}: the run did not go on to its end: {done.out[:500]}")
        for name in NAMES:
            path = os.path.join(there, name)
            attack.require(os.path.exists(path) and read(path) == read(os.path.join(plain, name)), f"{note}: {name} is not whole")
        attack.require(read(os.path.join(there, "video.mp4")) == b"earlier", f"{note}: the earlier video has changed")
        attack.leaves_nothing(there, note)

    def first(name, script):
        return {"PATH": f"{tool(attack, name, script)}:{os.environ['PATH']}"}

    for what, script in DYING.items():
        struck(f"an ffmpeg that {what}", first("ffmpeg", script))
    # Without ffprobe the mark of the format is all that is looked at.
    for what in ("reads all and writes nothing", "reads all and writes noise"):
        alone = tool(attack, "ffmpeg", DYING[what])
        for name in ("sh", "cat", "head", "rm"):
            os.symlink(shutil.which(name), os.path.join(alone, name))
        struck(f"an ffmpeg that {what}, without ffprobe", {"PATH": alone})
    # A broken ffprobe tells nothing of the video.
    for what, script in {"cannot start": "exit 127", "is killed": "kill -9 $$"}.items():
        there = attack.fresh()
        attack.judge(attack.run(*video, "--video", "video.mp4", cwd=there, env=first("ffprobe", script)), [OK], f"an ffprobe that {what}")
        attack.require(names(there) == ["video.mp4"], f"an ffprobe that {what}: left {names(there)}")
    # Images of the same run go on without the video, and alone it ends at once.
    there = attack.fresh()
    env = first("ffmpeg", DYING["is killed"])
    attack.judge(attack.run(*video, "--video", "video.mp4", "--frames", "images", cwd=there, env=env), [IO], "images and a video that dies")
    attack.require(len(names(os.path.join(there, "images"))) == 13, f"images and a video that dies: {names(there)}")
    attack.judge(attack.run(*VIDEO, "--duration", "100000", "--video", "video.mp4", cwd=there, env=env, timeout=40), [IO], "a video alone that dies")
    # Side by side too.
    there = attack.fresh()
    beside = ["--variant", "integrator=midpoint", "--state", "end.csv", "--video", "video.mp4"]
    attack.judge(attack.run(*video, *beside, cwd=there, env=env), [IO], "side by side, a video that dies")
    attack.require(names(there) == ["end-1.csv", "end-2.csv"], f"side by side, a video that dies: left {names(there)}")


HANGING = {
    "reads nothing": "exec sleep 1000",
    "reads nothing, behind a shell": "sleep 1000; exit 0",
    "stops in the middle": f"head -c {2 * FRAME} > /dev/null; sleep 1000",
    "never ends": "cat > /dev/null; sleep 1000",
    "stops reading and never ends": "exec 0<&-; sleep 1000",
}


def halts(attack):
    """An ffmpeg that hangs: one Ctrl-C ends the run within seconds, with everything but the video."""
    children = []
    for what, script in HANGING.items():
        there = attack.fresh()
        env = {"PATH": f"{tool(attack, 'ffmpeg', script)}:{os.environ['PATH']}"}
        words = [*VIDEO, "--duration", "1000", *FILES, "--every", "1000000", "--video", "video.mp4"]
        children.append((f"an ffmpeg that {what}", there, start(attack, words, there, env)))
    for note, there, child in children:
        attack.require(wait_until(lambda c=child, d=there: handles(c, signal.SIGINT) and len(names(d)) >= 4), f"{note}: it did not begin")
    time.sleep(3)  # most come to a halt by then
    for _, _, child in children:
        child.send_signal(signal.SIGINT)
    for note, there, child in children:
        code, err, seconds = end_of(attack, child, note, 40)
        attack.require(code == IO and b"cannot make the video" in err, f"{note}: ended {code} {err[:600]}")
        attack.require(names(there) == sorted(NAMES), f"{note}: left {names(there)}")


def images(attack):
    """Earlier images stay until the first new one is there."""
    there = attack.fresh()
    old = os.path.join(there, "images")
    os.mkdir(old)
    for n in range(3):
        write(os.path.join(old, f"frame-{n:06}.png"), f"earlier {n}")
    write(os.path.join(old, "frame-000001.jpg"), "earlier")
    kept = {p: read(p) for p in all_files(old)}
    words = [*VIDEO, "--duration", "0.02", "--frames", "images", "--force"]
    nothing = {"__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent", "ASPIC_EGL_DEVICE": None}
    attack.judge(attack.run(*words, cwd=there, env=nothing), [DEVICE], "without a device")
    attack.judge(attack.run(*words, "--view", "color=loud", cwd=there), [SCENE], "with a wrong view")
    attack.judge(attack.run(*words, "--speed", "1e-300", cwd=there), [USAGE], "with endless images")
    attack.require({p: read(p) for p in all_files(old)} == kept, f"earlier images are gone: {names(there)}")
    attack.judge(attack.run(*words, cwd=there), [OK], "with a device")
    attack.require(names(old) == ["frame-000000.png", "frame-000001.png", "frame-000002.png"] and
                   not any(read(p).startswith(b"earlier") for p in all_files(old)), f"with a device: left {names(old)}")


def pipes(attack):
    """A pipe that nobody reads, or whose reader stops: SIGTERM ends the run."""
    for option in ("--state", "--series", "--checkpoint"):
        there = attack.fresh()
        os.mkfifo(os.path.join(there, "pipe"))
        child = start(attack, [*RUN, option, "pipe"], there)
        attack.require(wait_until(lambda c=child: handles(c, signal.SIGTERM)), f"{option}: no handler")
        time.sleep(0.2)  # by now it waits; if not, the run ends all the same
        child.send_signal(signal.SIGTERM)
        code, err, _ = end_of(attack, child, f"{option} into a pipe without a reader", 20)
        attack.require(code == INTERRUPTED and b"pipe" in err, f"{option} into a pipe without a reader: ended {code} {err[:300]}")
        attack.require(stat.S_ISFIFO(os.stat(os.path.join(there, "pipe")).st_mode), f"{option}: the pipe is gone")
    there = attack.fresh()
    os.mkfifo(os.path.join(there, "pipe"))
    child = start(attack, [*LONG, "--series", "pipe", "--state", "end.csv"], there)
    reader = os.open(os.path.join(there, "pipe"), os.O_RDONLY)
    first = os.read(reader, 100)
    time.sleep(0.5)  # the pipe fills
    child.send_signal(signal.SIGTERM)
    code, err, _ = end_of(attack, child, "a reader that stops", 30)
    os.close(reader)
    attack.require(first.startswith(b"step,") and code == IO and names(there) == ["end.csv", "pipe"], f"a reader that stops: {code} {names(there)} {err[:300]}")
    # One that reads gets all.
    child = start(attack, [*RUN, "--series", "pipe"], there)
    with open(os.path.join(there, "pipe"), "rb") as reader:
        rows = reader.read().splitlines()
    code, err, _ = end_of(attack, child, "a reader that reads", 30)
    attack.require(code == OK and len(rows) == 14, f"a reader that reads: {code}, {len(rows)} rows {err[:300]}")
    # Reading from one that nobody writes.
    child = start(attack, ["run", "./pipe"], there)
    wait_until(lambda: handles(child, signal.SIGTERM))
    time.sleep(0.2)  # as above
    child.send_signal(signal.SIGTERM)
    code, err, _ = end_of(attack, child, "a scene from a silent pipe", 20)
    attack.require(code == INTERRUPTED, f"a scene from a silent pipe: ended {code} {err[:300]}")


def endless(attack):
    """Every reader with a file that has no end and with one of 5 GiB: refused at once, with little memory."""
    import resource
    limits = [(resource.RLIMIT_AS, 1 << 30)]
    there = attack.fresh()
    attack.judge(attack.run(*RUN, "--checkpoint", "whole.aspic", cwd=there), [OK], "a checkpoint to enlarge")
    grid = ["sweep", "cube-plane", *TINY, "--steps", "2", "--backend", "reference", "--vary", "contact.friction=0.1,0.2", "--out"]
    owner = sweep_owner(attack, grid, there)
    attack.require(owner.startswith(b"# aspic sweep: "), f"finished rows begin with {owner!r}")

    def huge(name, start=b"", gibibytes=5):
        path = write(os.path.join(there, name), start)
        os.truncate(path, gibibytes << 30)
        return path

    def refused(words, codes, note, env=None, say=b""):
        done = attack.run(*words, cwd=there, limits=limits, timeout=20, env=env)
        attack.judge(done, codes, note)
        attack.require(b"not enough memory" not in done.err and say in done.err and done.seconds < 10, f"{note}: {done}")

    for path, what in (("/dev/zero", "endless"), (huge("huge"), "5 GiB"), (huge("huge.toml", b"schema = 1\n"), "5 GiB of TOML")):
        for words in (["run", path], ["scene", "show", path], ["scene", "check", path], ["scene", "import", path], ["compare", path],
                      ["sweep", path, "--vary", "contact.friction=0.1,0.2", "--out", "none.csv"], ["report", path, "--out", "none"], ["bench", path],
                      ["view", path]):
            refused(words, [IO], f"{words[:-1]} {what}", say=b"is larger than 64")
        refused(["run", "--resume", path], [IO], f"--resume {what}")
    checkpoint = read(os.path.join(there, "whole.aspic"))
    refused(["run", "--resume", huge("head.aspic", checkpoint[:200])], [IO], "a checkpoint's head and 5 GiB", say=b"head.aspic")
    refused(["run", "--resume", huge("tail.aspic", checkpoint)], [IO], "a checkpoint and 5 GiB", say=b"tail.aspic")
    for start_with, codes in ((b"", [IO]), (owner, [IO]), (b"# aspic sweep: another\n", [USAGE])):
        path = huge("rows.csv.partial", start_with)
        refused([*grid, "rows.csv"], codes, f"finished rows of 5 GiB after {start_with[:20]!r}", say=b"rows.csv.partial")
        attack.require(os.path.getsize(path) == 5 << 30, f"finished rows after {start_with[:20]!r}: the file was changed")
    for device in ("/dev/zero", "/dev/null"):
        os.symlink(device, os.path.join(there, f"{device[5:]}.csv.partial"))
        refused([*grid, f"{device[5:]}.csv"], [IO], f"finished rows from {device}", say=b"device or a pipe")
    # The window reads its own file before it looks for a display.
    for place in ("zero", "huge", "pipe"):
        state = os.path.join(there, "state-" + place, "aspic")
        os.makedirs(state)
        file = os.path.join(state, "window.json")
        if place == "zero":
            os.symlink("/dev/zero", file)
        elif place == "huge":
            os.link(huge("huge.json", b'{"version": 2, "x": "'), file)
        else:
            os.mkfifo(file)
        refused(["view"], [DEVICE], f"the window's own file, {place}", {"XDG_STATE_HOME": os.path.join(there, "state-" + place), "DISPLAY": None, "WAYLAND_DISPLAY": None},
                say=b"Cannot use")
    kernels = os.path.join(there, "shaders", "compute")
    os.makedirs(kernels)
    os.rename(os.path.join(there, "huge"), os.path.join(kernels, "gather.comp"))
    gpu = ["run", "cube-plane", *TINY, "--steps", "2", "--backend", "gpu", "--force-path", "gather"]
    done = attack.run(*gpu, env={"ASPIC_SHADER_DIR": os.path.dirname(kernels)}, timeout=30)
    attack.judge(done, [IO, DEVICE], "a kernel of 5 GiB")


def sweep_owner(attack, grid, directory):
    """The first line that this sweep's file of finished rows has."""
    child = start(attack, [*grid, "slow.csv", "--jobs", "1"], directory)
    partial = os.path.join(directory, "slow.csv.partial")
    line = b""
    while child.poll() is None and not line.endswith(b"\n"):
        line = read(partial).split(b"\n")[0] + b"\n" if os.path.exists(partial) and b"\n" in read(partial) else b""
    child.communicate()
    return line


main({f.__name__: f for f in (links, hangups, encoders, halts, images, pipes, endless)})
