"""One run, one hash: whatever surrounds a run and however it is cut into pieces, it ends with the same bits."""
import os
import random

from attack import OK, hash_in, main, read

SCENES = [["cube-plane", "--set", "cube[0].particles-per-edge=4", "--set", "cube[0].position=[0,1.5,0]"],
          ["cube-and-balls", "--set", "cube[0].particles-per-edge=3", "--set", "ball[0].position=[0.3,4,0]"],
          ["goal-net", "--set", "goal-net[0].particles=[4,5,6]"],
          ["cube-bowl", "--set", "cube[0].particles-per-edge=3", "--set", "simulation.integrator=implicit-euler"]]
STEPS = "90"


def one(attack, words, note, wanted, **more):
    done = attack.run("run", *words, **more)
    if attack.judge(done, [OK], note):
        attack.require(hash_in(done) == wanted, f"{note}: {hash_in(done)}, not {wanted}")


def determinism(attack):
    """Repeats, backends, threads, vector widths, locales, cores, recording."""
    for scene in SCENES:
        words = [*scene, "--steps", STEPS]
        first = attack.run("run", *words, "--backend", "reference")
        attack.judge(first, [OK], str(words))
        wanted = hash_in(first)
        attack.require(wanted is not None, f"no hash: {first}")
        for n in range(5 if attack.thorough else 2):
            one(attack, [*words, "--backend", "reference"], f"repeat {n} of {scene[0]}", wanted)
            one(attack, [*words, "--backend", "gpu"], f"gpu, repeat {n} of {scene[0]}", wanted)
        gpu = [*words, "--backend", "gpu"]
        for threads in ("0", "1", "2", "3", "8"):
            one(attack, gpu, f"{threads} driver threads, {scene[0]}", wanted, env={"LP_NUM_THREADS": threads})
        for width in ("128", "256"):
            one(attack, gpu, f"vectors of {width} bits, {scene[0]}", wanted, env={"LP_NATIVE_VECTOR_WIDTH": width})
        if "simulation.integrator=implicit-euler" not in scene:
            one(attack, [*gpu, "--force-path", "per-spring"], f"per spring, {scene[0]}", wanted)
        one(attack, gpu, f"one core, {scene[0]}", wanted, before=lambda: os.sched_setaffinity(0, {min(os.sched_getaffinity(0))}))
        for locale in ("C", "de_DE.UTF-8", "tr_TR.UTF-8", "C.UTF-8"):
            one(attack, gpu, f"{locale}, {scene[0]}", wanted, env={"LC_ALL": locale})
        one(attack, [*words, "--backend", "reference", "--series", attack.path("s.csv"), "--every", "7", "--force"], f"with a series, {scene[0]}", wanted)
    video = [*SCENES[0], "--steps", STEPS, "--backend", "gpu"]
    wanted = hash_in(attack.run("run", *video))
    one(attack, [*video, "--frames", attack.path("frames"), "--size", "64x64", "--fps", "60"], "recorded", wanted)
    one(attack, [*video, "--video", attack.path("f.mp4"), "--size", "64x64", "--fps", "31", "--view", "color=strain"], "recorded in strain", wanted)


def pieces(attack):
    """Stopped at odd steps, resumed on either backend, the same checkpoints and tables as without the stop."""
    for scene in SCENES:
        for precision in ("single", "double"):
            words = ["--backend", "reference", "--precision", precision]
            whole = attack.path(f"whole-{precision}.aspic")
            first = attack.run("run", *scene, "--steps", STEPS, *words, "--checkpoint", whole, "--force", "--state", whole + ".csv")
            attack.judge(first, [OK], str(scene))
            wanted = hash_in(first)
            for _ in range(6 if attack.thorough else 2):
                last, at = None, 0
                for _ in range(random.randrange(1, 4)):
                    at = random.randrange(at, int(STEPS) + 1)
                    start = ["--resume", last] if last else scene
                    last, before = attack.path(f"at-{at}-{random.random()}.aspic"), last
                    backend = random.choice((["--backend", "gpu"], ["--backend", "reference"])) if precision == "single" else ["--backend", "reference"]
                    done = attack.run("run", *start, *backend, *([] if before else ["--precision", precision]), "--steps", str(at), "--checkpoint", last)
                    attack.judge(done, [OK], f"stopped at {at} of {scene[0]}")
                end = attack.path("end.aspic")
                one(attack, ["--resume", last, "--steps", STEPS, "--backend", "reference", "--checkpoint", end, "--state", end + ".csv", "--force"],
                    f"resumed at {at}, {scene[0]}, {precision}", wanted)
                attack.require(read(end) == read(whole), f"resumed at {at}, {scene[0]}, {precision}: the checkpoints differ")
                attack.require(read(end + ".csv") == read(whole + ".csv"), f"resumed at {at}, {scene[0]}, {precision}: the tables differ")


main({f.__name__: f for f in (determinism, pieces)})
