"""What surrounds a run: limits on resources, closed descriptors, full disks, the environment, and the names and ends of its
outputs."""
import os
import random
import re
import resource
import signal
import subprocess
import time

from attack import DEVICE, INTERRUPTED, IO, OK, SCENE, TINY, USAGE, all_files, hash_in, main, read, write

RUN = ["run", "cube-plane", *TINY, "--steps", "12", "--backend", "reference"]
FILES = ["--series", "series.csv", "--state", "end.csv", "--checkpoint", "end.aspic"]
VIDEO = ["run", "cube-plane", *TINY, "--duration", "0.02", "--backend", "gpu", "--size", "64x64", "--video", "video.mp4", "--text", "off"]


def after(attack, done, directory, codes, note, fatal_allowed=False):
    """Nothing is left, or every file is whole. A signal inside a driver is allowed where memory is short, with a sentence."""
    if fatal_allowed and isinstance(done.code, int) and done.code < 0:
        attack.require(done.code in (-6, -11, -7) and b"aspic: " in done.err, f"{note}: {done}")
    else:
        attack.judge(done, codes, note)
    attack.leaves_nothing(directory, note)
    if done.code != OK:
        attack.require(not os.path.exists(os.path.join(directory, "video.mp4")), f"{note}: a video was left")


def resources(attack):
    whole = attack.fresh()
    attack.judge(attack.run(*RUN, *FILES, cwd=whole), [OK], "without limits")
    complete = {os.path.basename(p): read(p) for p in all_files(whole)}

    def limited(words, limits, codes, note, fatal_allowed=False, timeout=60):
        there = attack.fresh()
        done = attack.run(*words, cwd=there, limits=limits, timeout=timeout)
        after(attack, done, there, codes, note, fatal_allowed)
        for path in all_files(there):
            if os.path.basename(path) in complete:
                attack.require(read(path) == complete[os.path.basename(path)], f"{note}: {path} is not whole")
        return done

    mib = 1 << 20
    # Below 20 MiB the system's loader does not get as far as the program.
    for size in range(20, 100, 2 if attack.thorough else 5):
        limited([*RUN, *FILES], [(resource.RLIMIT_AS, size * mib)], [OK, SCENE, IO, 127], f"{size} MiB of address space")
    for size in (120, 200, 300) if not attack.thorough else range(100, 700, 20):
        limited(["run", "cube-plane", *TINY, "--steps", "3", "--backend", "gpu"], [(resource.RLIMIT_AS, size * mib)], [OK, SCENE, DEVICE, IO],
                f"{size} MiB, gpu", True)
    for size in (420, 470, 540, 630) if not attack.thorough else range(300, 1000, 10):
        limited(VIDEO, [(resource.RLIMIT_AS, size * mib)], [OK, SCENE, DEVICE, IO], f"{size} MiB, video", True, 120)
    for size in (0, 1, 100, 4096, 12000):
        limited([*RUN, *FILES], [(resource.RLIMIT_FSIZE, size)], [OK, IO], f"files of {size} bytes")
    limited(VIDEO, [(resource.RLIMIT_FSIZE, 500)], [IO], "a video of 500 bytes")
    for kib in (64, 128, 256, 1024):
        limited([*RUN, *FILES], [(resource.RLIMIT_STACK, kib << 10)], [OK, IO], f"{kib} KiB of stack", kib < 256)
    limited(VIDEO, [(resource.RLIMIT_STACK, 256 << 10)], [OK, DEVICE, IO], "256 KiB of stack, video", True)
    for count in range(3, 14):
        limited([*RUN, *FILES], [(resource.RLIMIT_NOFILE, count)], [OK, IO, 127], f"{count} descriptors")
    for count in (6, 9, 12, 16):
        limited(VIDEO, [(resource.RLIMIT_NOFILE, count)], [OK, DEVICE, IO], f"{count} descriptors, video")
    limited([*RUN, *FILES], [(resource.RLIMIT_CORE, 0), (resource.RLIMIT_NPROC, 1)], [OK, IO], "one process")


def descriptors(attack):
    """Started without stdin, stdout or stderr, no output file may become one of them."""
    whole = attack.fresh()
    attack.judge(attack.run(*RUN, *FILES, cwd=whole), [OK], "with all descriptors")
    for closed in ((0,), (1,), (2,), (0, 1), (1, 2), (0, 1, 2)):
        there = attack.fresh()
        done = attack.run(*RUN, *FILES, cwd=there, close=closed)
        attack.require(done.code in (OK, IO), f"without {closed}: {done}")
        attack.leaves_nothing(there, f"without {closed}")
        for name in ("series.csv", "end.csv", "end.aspic"):
            path = os.path.join(there, name)
            if os.path.exists(path):
                attack.require(read(path) == read(os.path.join(whole, name)), f"without {closed}: {name} differs")
            else:
                attack.require(done.code != OK, f"without {closed}: {name} is missing")
        # A refusal writes its sentence: into no file.
        refused = attack.fresh()
        write(os.path.join(refused, "end.csv"), "earlier")
        attack.run(*RUN, *FILES, cwd=refused, close=closed)
        attack.require([os.path.basename(p) for p in all_files(refused)] == ["end.csv"] and read(os.path.join(refused, "end.csv")) == b"earlier",
                       f"without {closed}: a refused run left {all_files(refused)}")


def disks(attack):
    """Full, read-only and odd places; pipes that nobody reads."""
    for option in ("--series", "--state", "--checkpoint"):
        attack.judge(attack.run(*RUN, option, "/dev/full"), [IO], f"{option} /dev/full")
        attack.judge(attack.run(*RUN, option, "/dev/null"), [OK], f"{option} /dev/null")
        attack.judge(attack.run(*RUN, option, "/dev/stdout"), [OK], f"{option} /dev/stdout")
        for place in ("/proc/none", "/sys/none", "missing/end", "/", ".", "", "a" * 300, "/dev/full/x", "x" * 5000):
            attack.judge(attack.run(*RUN, option, place), [IO, USAGE] if place else [OK, IO, USAGE], f"{option} {place[:20]!r}")
    for words in (RUN, ["scene", "show", "goal-net"], ["scene", "list"], ["info"], ["--help"], [*RUN, "--json"],
                  ["compare", "cube-plane", *TINY, "--backends", "reference,reference:double", "--steps", "2"]):
        with open("/dev/full", "wb") as full:
            attack.judge(attack.run(*words, stdout=full), [IO], f"{words[:2]} on a full disk")
        reader, writer = os.pipe()
        os.close(reader)
        done = attack.run(*words, stdout=writer)
        os.close(writer)
        attack.require(done.code == 141 and not done.err, f"{words[:2]} into a pipe without a reader: {done}")
    # A message that cannot be written changes no exit code.
    with open("/dev/full", "wb") as full:
        attack.require(attack.run("run", "nowhere", stderr=full).code == SCENE, "a message on a full disk changes the exit code")
    if os.path.ismount("/dev/shm") and os.geteuid() != 0:
        closed = attack.fresh()
        os.chmod(closed, 0o555)
        attack.judge(attack.run(*RUN, *FILES, cwd=closed), [IO], "a directory closed to us")
        os.chmod(closed, 0o755)


ODD_NAMES = [" ", "a b.csv", "-", "--", "-x.csv", "ä ö.csv", "a\nb.csv", "a\tb.csv", "\x1b[31m.csv", "\u202egpj.csv", b"\xff\xfe.csv", "'\"$(x).csv",
             "%s%n.csv", "{}.csv", "." * 3 + "csv", "a" * 255, "con.csv", "~", "*?.csv", "a;b.csv"]


def outputs(attack):
    for name in ODD_NAMES:
        there = attack.fresh()
        for option in (b"--state", b"--series", b"--checkpoint"):
            # A name with an ending must have one that its option knows.
            path = os.path.join(os.fsencode(there), re.sub(b"csv$", b"aspic" if option == b"--checkpoint" else b"csv", os.fsencode(name)))
            done = attack.run(*RUN, option, path, b"--force", cwd=there)
            attack.judge(done, [OK], f"{option} {name!r}")
            attack.require(os.path.exists(path), f"{option} {name!r}: no file")
            attack.require(b"\x1b" not in done.out and b"\xff" not in done.out and "\u202e".encode() not in done.out,
                           f"{option} {name!r}: control characters on stdout: {done.out}")
            refused = attack.run(*RUN, option, path, cwd=there)
            attack.judge(refused, [IO], f"{option} {name!r} once more")
        attack.leaves_nothing(there, repr(name))
        scene = os.path.join(os.fsencode(there), b"s" + os.fsencode(name)[:200])
        write(scene, b"schema = 1\nunknown = 1\n")
        attack.judge(attack.run("scene", "show", scene), [SCENE], f"a scene called {name!r}")
    there = attack.fresh()
    write(os.path.join(there, "target.csv"), "earlier")
    os.symlink("target.csv", os.path.join(there, "link.csv"))
    os.symlink("loop.csv", os.path.join(there, "loop.csv"))
    os.mkfifo(os.path.join(there, "unread"))
    attack.judge(attack.run(*RUN, "--state", "link.csv", "--force", cwd=there), [OK], "through a link")
    attack.require(os.path.islink(os.path.join(there, "link.csv")) and read(os.path.join(there, "target.csv")) != b"earlier", "a link was replaced")
    attack.judge(attack.run(*RUN, "--state", "loop.csv", cwd=there), [IO], "through a link to itself")
    attack.judge(attack.run(*RUN, "--state", "same.csv", "--series", "./same.csv", cwd=there), [USAGE], "two outputs of one name")
    os.chmod(os.path.join(there, "target.csv"), 0o640)
    attack.judge(attack.run(*RUN, "--state", "target.csv", "--force", cwd=there), [OK], "over a file with a mode")
    attack.require(os.stat(os.path.join(there, "target.csv")).st_mode & 0o777 == 0o640, "the mode was not kept")
    # Two at once for one name: one wins, the other is refused, the file is whole.
    for _ in range(5):
        place = attack.fresh()
        words = [attack.program, *RUN, "--state", "end.csv"]
        two = [subprocess.Popen(words, cwd=place, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for _ in range(2)]
        codes = sorted(child.wait() for child in two)
        attack.require(codes == [OK, IO], f"two at once ended {codes}")
        attack.require(len(all_files(place)) == 1, f"two at once left {all_files(place)}")


def kills(attack):
    """Signals at random times of long runs, with and without images."""
    long_run = ["run", "cube-plane", "--backend", "reference", "--set", "cube[0].particles-per-edge=4", "--steps", "100000000", *FILES]
    video = ["run", "cube-plane", *TINY, "--backend", "gpu", "--duration", "100", "--size", "64x64", "--video", "video.mp4", "--checkpoint", "end.aspic"]
    plan = [(long_run, s) for s in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL, signal.SIGHUP)] * (10 if attack.thorough else 3)
    plan += [(video, s) for s in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)] * (5 if attack.thorough else 1)
    for words, number in plan:
        there = attack.fresh()
        write(os.path.join(there, "end.aspic"), "earlier")
        child = subprocess.Popen([attack.program, *words, "--force"], cwd=there, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        time.sleep(random.uniform(0.0, 0.6))  # the moment of the signal, not a wait for anything
        child.send_signal(number)
        try:
            out, err = child.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            child.kill()
            child.communicate()
            attack.blame(f"{signal.Signals(number).name}: the program went on")
            continue
        attack.runs += 1
        note = f"{signal.Signals(number).name} {words[:2]} ended {child.returncode} {err[:200]}"
        checkpoint = os.path.join(there, "end.aspic")
        if child.returncode == INTERRUPTED:
            reached = int(re.search(rb"at step (\d+)", err).group(1))
            done = attack.run("run", "--resume", checkpoint, "--steps", str(reached + 2), "--backend", "reference")
            attack.judge(done, [OK], f"{note}: resuming")
            attack.leaves_nothing(there, note)
            if words is video:
                probe = subprocess.run(["ffprobe", "-v", "error", os.path.join(there, "video.mp4")], capture_output=True, check=False)
                attack.require(probe.returncode == 0, f"{note}: the video is broken")
        else:
            attack.require(child.returncode == -number, note)
            if number != signal.SIGKILL:
                attack.leaves_nothing(there, note)
            attack.require(read(checkpoint) == b"earlier", f"{note}: the earlier checkpoint has changed")
            attack.require(not os.path.exists(os.path.join(there, "video.mp4")), f"{note}: a video was left")


def environment(attack):
    """Nothing around the program changes its result or breaks it."""
    wanted = hash_in(attack.run(*RUN))
    locales = subprocess.run(["locale", "-a"], capture_output=True, check=False).stdout.decode().split()
    odd = [{"LC_ALL": name} for name in [*locales[:20], "de_DE.UTF-8", "tr_TR.UTF-8", "nonsense", "\x1b[2J", "a" * 5000, ""]]
    odd += [{name: None} for name in ("HOME", "PATH", "TMPDIR", "LANG", "USER", "DISPLAY")]
    odd += [{name: value} for name in ("HOME", "TMPDIR", "XDG_STATE_HOME", "XDG_CACHE_HOME", "TERM", "COLUMNS")
            for value in ("", "/nonexistent", "/dev/null", "relative", "\x1b[2J", "x" * 4000)]
    odd += [{"ASPIC_EGL_DEVICE": value} for value in ("", "-1", "99", "nonsense", "\x1b[2J", "9" * 40, "software")]
    odd += [{"ASPIC_SHADER_DIR": value} for value in ("", "/nonexistent", "/dev/null", attack.directory)]
    odd += [{"ASPIC_NONSENSE": "1"}, {"OMP_NUM_THREADS": "-1"}, {"MALLOC_PERTURB_": "165"}, {"MALLOC_ARENA_MAX": "1"}]
    for env in odd:
        done = attack.run(*RUN, env=env)
        if attack.judge(done, [OK], f"with {env}"):
            attack.require(hash_in(done) == wanted, f"with {env}: {hash_in(done)}, not {wanted}")
    gpu = ["run", "cube-plane", *TINY, "--steps", "12", "--backend", "gpu"]
    for env in ({"ASPIC_EGL_DEVICE": v} for v in ("", "-1", "99", "nonsense", "\x1b[2J", "9" * 40, "hardware", "software", "surfaceless", "default", "0")):
        done = attack.run(*gpu, env=env)
        if attack.judge(done, [OK, DEVICE], f"gpu with {env}") and done.code == OK:
            attack.require(hash_in(done) == wanted, f"gpu with {env}: {hash_in(done)}, not {wanted}")
    for env in ({"__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent"}, {"LIBGL_DRIVERS_PATH": "/nonexistent"}, {"GALLIUM_DRIVER": "nonsense"},
                {"MESA_GL_VERSION_OVERRIDE": "3.0"}, {"MESA_LOADER_DRIVER_OVERRIDE": "nonsense"}, {"EGL_PLATFORM": "nonsense"},
                {"XDG_RUNTIME_DIR": "/nonexistent"}, {"MESA_SHADER_CACHE_DIR": "/dev/null"}, {"HOME": None}):
        done = attack.run(*gpu, env=env)
        if attack.judge(done, [OK, DEVICE], f"gpu with {env}") and done.code == OK:
            attack.require(hash_in(done) == wanted, f"gpu with {env}: {hash_in(done)}, not {wanted}")
    shaders(attack, gpu)


def shaders(attack, gpu):
    """Directories of shaders that are none."""
    def answer(note, make):
        there = os.path.join(attack.fresh(), "shaders")
        os.makedirs(os.path.join(there, "compute"))
        make(there)
        attack.judge(attack.run(*gpu, env={"ASPIC_SHADER_DIR": there}, timeout=60), [OK, DEVICE, IO], note)

    kernel = "compute/gather.comp"
    answer("a directory for a kernel", lambda d: os.mkdir(os.path.join(d, kernel)))
    answer("an empty kernel", lambda d: write(os.path.join(d, kernel), b""))
    answer("a kernel of noise", lambda d: write(os.path.join(d, kernel), random.randbytes(5000)))
    answer("a kernel of escapes", lambda d: write(os.path.join(d, kernel), b"\x1b[2J\x1b]0;x\x07 void\n"))
    answer("a kernel that includes itself", lambda d: write(os.path.join(d, kernel), f'#include "{kernel}"\n'.encode()))
    answer("a kernel of zeros", lambda d: os.symlink("/dev/zero", os.path.join(d, kernel)))
    answer("a kernel that is a pipe", lambda d: os.symlink("/dev/null", os.path.join(d, kernel)))

    def nested(there):
        for n in range(20000):
            write(os.path.join(there, f"{n}.glsl"), f'#include "{n + 1}.glsl"\n')
        write(os.path.join(there, kernel), b'#include "0.glsl"\n')

    answer("20,000 nested includes", nested)


main({f.__name__: f for f in (resources, descriptors, disks, outputs, kills, environment)})
