"""Images and videos."""

import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import threading
from collections.abc import Callable
from typing import Any

import aspic
import numpy as np
import pytest
from conftest import needs_images, read_png, simulation


def test_an_image_is_an_array_that_notebooks_show(sim: aspic.Simulation) -> None:
    needs_images()
    image = sim.render(96, 54)
    assert image.shape == (54, 96, 3) and image.dtype == np.uint8 and len(np.unique(image)) > 20
    shown = image._repr_png_()
    assert shown is not None and np.array_equal(read_png(shown), image)
    image.save("a.png")
    assert pathlib.Path("a.png").read_bytes() == shown
    assert image[10]._repr_png_() is None and "96 × 54" in repr(image) and repr(image[0, 0]).startswith("Image")
    part = image[::2, 5:40]
    assert np.array_equal(read_png(part.png()), part)
    with pytest.raises(ValueError, match="not an image"):
        image[0].png()
    assert type(image / 2) is np.ndarray and isinstance(image.sum(), np.integer)


def test_all_backends_give_the_image_of_a_video(scene: aspic.Scene) -> None:
    needs_images()
    images = []
    for backend in ("reference", "gpu"):
        sim = simulation(scene, backend)
        sim.step(120)
        images.append(sim.render(80, 45))
    assert np.array_equal(images[0], images[1])
    sim.video("frames", steps=50, fps=40, width=80, height=45)
    frames = sorted(pathlib.Path("frames").iterdir())
    assert len(frames) >= 3 and sim.steps == 170
    assert np.array_equal(read_png(frames[0].read_bytes()), images[0])
    assert np.array_equal(read_png(frames[-1].read_bytes()), sim.render(80, 45))


@pytest.mark.parametrize("edge", [0.02, 0.25, 50.0])
def test_bodies_of_any_size_are_seen_without_a_view(edge: float) -> None:
    needs_images()
    scene = aspic.Scene('schema = 1\n[[terrain]]\nshape = "plane"\npoint = [0, 0, 0]\n')
    scene.add("cube", edge_length=edge, particles_per_edge=4, position=(0, 0.6 * edge, 0))
    sim = aspic.Simulation(scene, "cpu")
    seen = sim.render(96, 54, text=False).astype(int)
    assert 0.1 < (seen[..., 0] > 1.3 * seen[..., 1]).mean() < 0.25  # the red cube
    sim.video("frames", steps=0, width=96, height=54, text=False)
    assert np.array_equal(read_png(next(pathlib.Path("frames").iterdir()).read_bytes()), seen)


def test_an_instance_of_a_batch_has_the_image_of_a_simulation(scene: aspic.Scene) -> None:
    needs_images()
    batch = aspic.Batch(scene, count=2, threads=1)
    batch.step(100)
    batch[1].velocities = batch[1].velocities + np.float32([2, 0, 0])
    batch.step(100)
    lone = aspic.Simulation(scene, "cpu")
    lone.step(200)
    view = {"color": "strain"}
    image = batch[0].render(96, 54, view)
    assert image.png() == lone.render(96, 54, view).png()
    assert not np.array_equal(batch[1].render(96, 54, view), image)


def test_a_view_holds_for_one_image(scene: aspic.Scene) -> None:
    needs_images()
    sim = aspic.Simulation(scene, "cpu")
    sim.step(400)
    plain = sim.render(80, 45, text=False)
    assert not np.array_equal(sim.render(320, 180), sim.render(320, 180, text=False))
    strain = sim.render(80, 45, {"color": "strain", "camera.position": [6, 4, 6]}, text=False)
    assert not np.array_equal(plain, strain)
    assert np.array_equal(plain, sim.render(80, 45, text=False))
    with pytest.raises(aspic.SceneError, match="did you mean 'color'"):
        sim.render(view={"colr": "strain"})
    for size in ((0, 45), (80, -1), (10**6, 10**6)):
        with pytest.raises(aspic.Error):
            sim.render(*size)


def test_balls_are_drawn_by_the_state_alone() -> None:
    needs_images()
    sim = aspic.Simulation("cube-and-balls", "cpu")
    sim.render(80, 45)
    sim.step(150)
    other = aspic.Simulation("cube-and-balls", "cpu")
    other.step(150)
    assert np.array_equal(sim.render(80, 45), other.render(80, 45))


def test_images_follow_other_constants(scene: aspic.Scene) -> None:
    needs_images()
    sim = aspic.Simulation(scene, "cpu")
    before = sim.render(480, 270)
    sim.update({"simulation.timestep": 5e-4})
    assert not np.array_equal(sim.render(480, 270), before)  # the text names the time step


@pytest.mark.skipif(not shutil.which("ffmpeg"), reason="videos need ffmpeg")
def test_videos_are_written_and_not_overwritten(scene: aspic.Scene) -> None:
    needs_images()
    sim = aspic.Simulation(scene, "cpu")
    sim.video("a.mp4", 0.1, width=64, height=36)
    assert pathlib.Path("a.mp4").stat().st_size > 500 and sim.steps == 100
    with pytest.raises(aspic.FileError, match="exists"):
        sim.video("a.mp4", 0.1, width=64, height=36)
    assert sim.steps == 100
    with pytest.raises(aspic.Error):
        sim.video("a.xyz", 0.1)
    sim.video("a.mp4", 0.05, width=64, height=36, overwrite=True)


def test_a_video_of_a_divergence_is_complete(scene: aspic.Scene) -> None:
    needs_images()
    sim = aspic.Simulation(scene.copy({"simulation.timestep": 0.1}), "cpu")
    with pytest.raises(aspic.DivergedError):
        sim.video("frames", 100.0, fps=10, width=64, height=36)
    assert len(list(pathlib.Path("frames").iterdir())) >= sim.steps


def test_ctrl_c_completes_a_video(scene: aspic.Scene) -> None:
    needs_images()
    sim = aspic.Simulation(scene, "cpu")

    def stop() -> None:
        while not list(pathlib.Path("frames").glob("*.png")):
            pass
        os.kill(os.getpid(), signal.SIGINT)

    thread: Any = threading.Thread(target=stop)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        sim.video("frames", steps=10**9, width=64, height=36)
    thread.join()
    last = sorted(pathlib.Path("frames").glob("*.png"))[-1]
    assert np.array_equal(read_png(last.read_bytes()), sim.render(64, 36))


def text_of(path: str) -> str:
    return pathlib.Path(path).read_text(encoding="utf-8")


def test_a_page_holds_the_run(scene: aspic.Scene) -> None:
    sim = aspic.Simulation(scene, "cpu")
    sim.step(10)
    sim.page("a.html", steps=30, fps=100)
    assert sim.steps == 40 and sim.hash in text_of("a.html")
    again = aspic.Simulation(scene, "reference")
    again.step(10)
    again.page("b.html", steps=30, fps=50)
    assert again.hash in text_of("b.html")
    assert len(text_of("b.html")) < len(text_of("a.html")), "half the images"
    with pytest.raises(aspic.FileError, match="overwrite"):
        sim.page("a.html", steps=1)
    assert sim.steps == 40
    sim.page("a.html", steps=1, overwrite=True)
    assert sim.steps == 41 and sim.hash in text_of("a.html")
    for wrong in ({"fps": 0.0}, {"speed": -1.0}, {"steps": 10**12}):
        with pytest.raises(aspic.UsageError):
            sim.page("c.html", **{"steps": 1, **wrong})
    with pytest.raises(aspic.UsageError, match="html"):
        sim.page("c.mp4", steps=1)
    assert not pathlib.Path("c.html").exists() and sim.steps == 41


def test_a_page_has_the_command_that_repeats_it(
    scene: aspic.Scene, program: Callable[..., dict[str, Any]], tmp_path: pathlib.Path
) -> None:
    def command_of(sim: aspic.Simulation, **options: Any) -> str:
        sim.page("p.html", steps=30, overwrite=True, **options)
        found = re.search(r'"command":("(?:[^"\\]|\\.)*")', text_of("p.html"))
        assert found
        return str(json.loads(found[1]))

    changed = scene.copy({"view.color": "strain", "contact.friction": 0.25, "cube[0].rotation.axis": [0, 1, 0.5]})
    sim = aspic.Simulation(changed, "cpu")
    aspic_, *words = shlex.split(command_of(sim, fps=20.0))
    assert aspic_ == "aspic" and words[-6:] == ["--steps", "30", "--html", "p.html", "--fps", "20.0"]
    page = text_of("p.html")
    assert program(*words, "--force")["state_hash"] == sim.hash
    # Also the page's bytes, but for the command, in which there is --force and --json.
    facts = re.compile(r'"command":"(?:[^"\\]|\\.)*"')
    assert facts.sub("", text_of("p.html")) == facts.sub("", page)
    doubles = aspic.Simulation(scene, "reference", precision="double")
    words = shlex.split(command_of(doubles))[1:]
    assert program(*words, "--force")["state_hash"] == doubles.hash

    # A scene of one's own, a second cube, a run that is under way, was moved or is pulled have none.
    own, two = aspic.Scene(scene.toml.replace('name = "cube-plane"', 'name = "mine"')), aspic.Scene(
        scene.toml + "[[cube]]\nposition = [9.0, 9.0, 9.0]\n"
    )
    assert [command_of(aspic.Simulation(s, "cpu")) for s in (own, two)] == ["", ""]
    moved, pulled, late = (aspic.Simulation(scene, "cpu") for _ in range(3))
    moved.positions = moved.positions + np.float32(0.5)
    pulled.pulls = [aspic.Pull(0, (0.0, 1.0, 0.0), 100.0)]
    late.step(1)
    assert [command_of(s) for s in (moved, pulled, late)] == ["", "", ""]


def test_a_page_of_a_divergence_is_complete(scene: aspic.Scene) -> None:
    sim = aspic.Simulation(scene.copy({"simulation.timestep": 0.1}), "cpu")
    with pytest.raises(aspic.DivergedError):
        sim.page("a.html", 100.0, fps=10)
    assert sim.hash in text_of("a.html")


def test_a_live_page_simulates_the_run_or_says_why_not(scene: aspic.Scene) -> None:
    sim = aspic.Simulation(scene, "cpu")
    try:
        sim.page("live.html", steps=20, live=True)
    except aspic.FileError as error:
        assert "scripts/wasm.sh" in str(error)
    else:
        assert sim.hash in text_of("live.html") and "wasm-unsafe-eval" in text_of("live.html")
        doubles = aspic.Simulation(scene, "reference", precision="double")
        with pytest.raises(aspic.UsageError, match="single precision"):
            doubles.page("d.html", steps=1, live=True)
        sim.pulls = [aspic.Pull(0, (0.0, 1.0, 0.0), 100.0)]
        with pytest.raises(aspic.UsageError, match="pulls"):
            sim.page("p.html", steps=1, live=True)
    assert not pathlib.Path("d.html").exists() and not pathlib.Path("p.html").exists()
