"""Damaged files and nonsense on the command line, through the program: scenes, checkpoints, Configuration.txt, options.
tests/fuzz does the same to the parsers, a thousand times as often; here the whole of the program answers."""
import json
import os
import random
import struct

from attack import DEVICE, DIVERGED, IO, OK, SCENE, TINY, USAGE, fnv1a, hash_in, main, read, write

BYTES = [0x00, 0x09, 0x0A, 0x1B, 0x22, 0x27, 0x2D, 0x30, 0x39, 0x5B, 0x5D, 0x65, 0x7B, 0x7F, 0x9B, 0xC3, 0xFF]


def damages(data, count):
    """`count` damaged copies: cuts, flipped bits, changed, doubled, moved and lost pieces."""
    for _ in range(count):
        copy = bytearray(data)
        at, to = sorted((random.randrange(len(data)), random.randrange(len(data))))
        kind = random.randrange(7)
        if kind == 0:
            copy = copy[:at]
        elif kind == 1:
            copy[at] ^= 1 << random.randrange(8)
        elif kind == 2:
            copy[at] = random.choice(BYTES)
        elif kind == 3:
            copy[at:at] = copy[at:min(to, at + 200)]
        elif kind == 4:
            del copy[at:min(to, at + 40)]
        elif kind == 5:
            copy[at:at] = bytes([random.choice(BYTES)]) * random.choice((1, 3, 1000))
        else:
            for _ in range(8):
                copy[random.randrange(len(copy))] ^= 1 << random.randrange(8)
        yield bytes(copy)


def scenes(attack):
    names = [scene["name"] for scene in json.loads(attack.run("scene", "list", "--json").out)["scenes"]]
    attack.require(len(names) >= 9, f"built-in scenes: {names}")
    for name in names:
        whole = attack.run("scene", "show", name).out
        for n, damaged in enumerate(damages(whole, 200 if attack.thorough else 45)):
            scene = write(attack.path("scene.toml"), damaged)
            note = f"damage {n} of {name}"
            # Numbers may have become large: what a scene can ask of a machine is not the matter here.
            done = attack.run("scene", "show", scene, timeout=20)
            if not attack.judge(done, [OK, SCENE], note) or done.code != OK:
                continue
            again = attack.run("scene", "show", write(attack.path("again.toml"), done.out))
            attack.require(again.code == OK and again.out == done.out, f"{note}: what was shown is not read back: {again}")
            few = attack.run("run", scene, "--backend", "reference", "--steps", "2", *few_particles(done.out), timeout=30)
            attack.judge(few, [OK, SCENE, DIVERGED, USAGE], note)


def few_particles(text):
    """Arguments that make a scene small, as far as its lists go."""
    words = []
    for cube in range(text.count(b"[[cube]]")):
        words += ["--set", f"cube[{cube}].particles-per-edge=2"]
    for net in range(text.count(b"[[goal-net]]")):
        words += ["--set", f"goal-net[{net}].particles=[2,2,2]"]
    for launcher in range(text.count(b"[[launcher]]")):
        words += ["--set", f"launcher[{launcher}].count=3"]
    return words


HEADER = 42  # bytes before the version's text, docs/files.md


def sealed(data):
    """The checksum made right."""
    return bytes(data[:-8]) + struct.pack("<Q", fnv1a(data[:-8]))


def fields(data):
    """Places of the lengths and texts."""
    version = struct.unpack_from("<Q", data, HEADER)[0]
    scene_at = HEADER + 8 + version
    scene = struct.unpack_from("<Q", data, scene_at)[0]
    return version, scene_at, scene, scene_at + 8 + scene


def with_scene(data, text):
    _, scene_at, _, counts_at = fields(data)
    return sealed(data[:scene_at] + struct.pack("<Q", len(text)) + text + data[counts_at:])


def checkpoints(attack):
    path = attack.path("good.aspic")
    made = attack.run("run", "cube-and-balls", "--backend", "reference", *TINY, "--steps", "3", "--checkpoint", path)
    attack.judge(made, [OK], "making a checkpoint")
    good = read(path)
    resume = ["run", "--backend", "reference", "--steps", "6", "--resume"]
    end = hash_in(attack.run(*resume, path))

    def refused(data, note):
        done = attack.run(*resume, write(attack.path("bad.aspic"), data), timeout=20)
        attack.judge(done, [USAGE, SCENE, IO], note)
        attack.require(len(done.err) < 20000, f"{note}: a message of {len(done.err)} bytes")

    # Without a checksum that belongs to it no damage is ever accepted.
    for at in list(range(0, HEADER + 16)) + [random.randrange(len(good)) for _ in range(400 if attack.thorough else 120)]:
        flipped = bytearray(good)
        flipped[at] ^= 1 << random.randrange(8)
        refused(bytes(flipped), f"bit of byte {at}")
        refused(good[:at], f"cut to {at} bytes")
    refused(good + b"\0", "one byte more")
    # With one: whatever cannot be is refused before anything is allocated for it.
    version, scene_at, scene, counts_at = fields(good)
    numbers = [1, 2**31, 2**32 + 1, 2**63, 2**64 - 1, 2**61 // 48]
    for at in (HEADER, scene_at, counts_at, counts_at + 8):
        for number in numbers:
            changed = bytearray(good)
            struct.pack_into("<Q", changed, at, number)
            refused(sealed(changed), f"length {number} at {at}")
    for h in (float("nan"), float("inf"), 0.0, -1.0, 0.5, 5e-324):
        changed = bytearray(good)
        struct.pack_into("<d", changed, 26, h)
        refused(sealed(changed), f"time step {h}")
    for width in (0, 1, 8, 16, 2**32 - 1):
        changed = bytearray(good)
        struct.pack_into("<I", changed, 14, width)
        refused(sealed(changed), f"{width} bytes a number")
    for spoilt in (float("nan"), float("inf"), 1e30):
        changed = bytearray(good)
        struct.pack_into("<f", changed, counts_at + 16, spoilt)
        refused(sealed(changed), f"a position of {spoilt}")
    # A version text is shown only where the scene is not accepted: it must not reach the terminal as it is.
    for text in (b"\x1b]0;title\x07" + b"\x1b[2J", b"9" * (1 << 20), b"\xff\xfe", "\u202e0.1".encode()):
        changed = sealed(good[:HEADER] + struct.pack("<Q", len(text)) + text + good[scene_at:])
        done = attack.run(*resume, write(attack.path("bad.aspic"), changed))
        attack.judge(done, [OK, USAGE, SCENE, IO], f"version text {text[:20]}")
        refused(with_scene(changed, b"schema = 1\nunknown = 3\n"), f"version text {text[:20]} of a refused scene")
    toml = good[scene_at + 8:counts_at]
    huge = [toml.replace(b"particles-per-edge = 2", b"particles-per-edge = 400"), toml.replace(b"schema = 1", b"schema = 2"), b"",
            toml + b"\n[[launcher]]\ncount = 10000000\n", b"x = " + b"[" * 200000, b"a" + b".a" * 100000 + b" = 1\n",
            toml.replace(b"timestep = ", b"timestep = 1"), b"\x1b[31m = 1", b"\xff" * 1000]
    for n, text in enumerate(huge):
        if text != toml:
            refused(with_scene(good, text), f"scene {n} inside")
    # Files that never end, are no files, or are not there.
    for name in ("/dev/zero", "/dev/full", "/dev/null", "/", attack.directory, "/proc/self/mem", attack.path("none"), "", "\x1b[2J"):
        done = attack.run(*resume, name, timeout=20)
        attack.judge(done, [USAGE, IO], f"resuming {name!r}")
    again = attack.run(*resume, path)
    attack.require(hash_in(again) == end, "the good checkpoint still resumes to the same end")
    attack.require(read(path) == good, "the good checkpoint is as it was")


def configurations(attack):
    whole = read(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "import", "Configuration.txt"))
    keys = [line for line in whole.splitlines() if line.startswith(b"*")]
    values = [b"nan", b"-nan", b"inf", b"1e308", b"-1", b"0", b"1e-320", b"999999999999", b"x", b"", b"\xff\xfe", b"\x1b[31m", b"true", b"0x10"]
    inputs = list(damages(whole, 300 if attack.thorough else 120))
    inputs += [key + b"\n" + value + b"\n" for key in keys for value in (values if attack.thorough else random.sample(values, 5))]
    inputs += [b"\x7fELF\x02\x01\x01" + bytes(range(256)) * 40, b"\xff" * 5000, b"*" * 5000, b"\n" * 5000, "*\u202eabc\n1\n".encode()]
    for n, text in enumerate(inputs):
        done = attack.run("scene", "import", write(attack.path("Configuration.txt"), text))
        if attack.judge(done, [OK, SCENE, IO], f"configuration {n} {text[:60]}") and done.code == OK:
            shown = attack.run("scene", "show", write(attack.path("imported.toml"), done.out))
            # A net larger than this machine's memory is refused by the scene's reader alone.
            attack.require(shown.code == OK or b"memory" in shown.err, f"imported from configuration {n} {text[:60]} but refused: {shown}")


NUMBERS = ["", "-1", "0", "1e400", "nan", "inf", "-inf", "0x10", "1,5", " 7", "9223372036854775808", "18446744073709551616",
           "99999999999999999999", "1e19", "\x1b[2J", "\xff", "½", "1" * 5000, "--", "-"]


# Without images these options are refused whatever their values.
OF_IMAGES = ("--fps", "--speed", "--size", "--text", "--frames-format")
IMAGES = ["--frames", "images", "--force"]


def options(attack):
    run = ["run", "cube-plane", "--backend", "reference", *TINY]
    # Each form must end at once, with a sentence; a number that is accepted must be a number.
    for option in ("--steps", "--duration", "--every", "--fps", "--speed", "--size", "--backend", "--precision", "--force-path", "--text",
                   "--frames-format"):
        for value in NUMBERS:
            extra = ["--series", "s.csv", "--force"] if option == "--every" else IMAGES if option in OF_IMAGES else []
            short = [] if option in ("--steps", "--duration") else ["--steps", "2"]
            done = attack.run(*run, *short, *extra, option, value.encode("utf-8", "surrogateescape"), timeout=30)
            attack.judge(done, [OK, USAGE, SCENE, *([DEVICE] if extra == IMAGES else [])], f"{option} {value[:40]!r}")
    for value in NUMBERS:
        for words in (["compare", "cube-plane", *TINY, "--backends", "reference,reference:double", "--steps", value],
                      ["compare", "cube-plane", *TINY, "--backends", "reference,reference:double", "--steps", "1", "--tolerance", value],
                      ["bench", "--size", value], ["bench", "--seconds", value, "--size", "2", "--backend", value],
                      ["run", value], ["scene", "show", value], ["scene", value], [value], ["verify", "--only", value],
                      ["scene", "show", "cube-plane", "--set", value], ["scene", "show", "cube-plane", "--set", f"simulation.timestep={value}"]):
            if words[0] == "" or value == "0" and words[0] == "compare":
                continue
            done = attack.run(*(w.encode("utf-8", "surrogateescape") for w in words), timeout=20)
            attack.judge(done, [OK, 1, USAGE, SCENE, IO], f"{words}")
    deep = ["a" + ".a" * 60000 + "=1", "x={" + "a." * 60000 + "a=1}", "x=" + "[" * 60000, "x=" + "{a=" * 40000, "cube[0]" + "[0]" * 30000 + "=1",
            "cube[99999999999999999999].position=[0,0,0]", "=", "a=", "=1", "cube[-1].velocity=[0,0,0]", "\x1b[2J=1", "simulation.timestep=\x1b"]
    for argument in deep:
        done = attack.run("scene", "show", "cube-plane", "--set", argument, timeout=20)
        attack.judge(done, [USAGE, SCENE], f"--set {argument[:40]!r}")
        attack.require(len(done.err) < 200000, f"--set {argument[:40]!r}: a message of {len(done.err)} bytes")
        done = attack.run(*run, *IMAGES, "--steps", "1", "--view", argument, timeout=20)
        attack.judge(done, [OK, USAGE, SCENE], f"--view {argument[:40]!r}")
    for value in range(300 if attack.thorough else 60):
        word = "".join(random.choice("abc=.[]{}\"'\\-0123456789eE,\x1b\u202e\n\t ") for _ in range(random.randrange(1, 40)))
        attack.judge(attack.run("scene", "show", "cube-plane", "--set", word), [OK, USAGE, SCENE], f"--set {word!r}")
        attack.judge(attack.run("scene", "show", word), [USAGE, SCENE, IO], f"scene {word!r}")


main({f.__name__: f for f in (scenes, checkpoints, configurations, options)})
