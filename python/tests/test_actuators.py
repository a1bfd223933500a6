"""Actuators: built from Python, driven by inputs, in environments."""

import re
from typing import Any

import aspic
import numpy as np
import pytest
from conftest import backends, simulation


@pytest.fixture
def robot() -> aspic.Scene:
    """A beam of fat under muscle, above the ground, without gravity."""
    made = aspic.Scene(name="robot")
    made.update({"simulation.gravity": [0, 0, 0], "simulation.integrator": "symplectic-euler"})
    made.add_material("fat", density=1000, youngs_modulus=1e5, damping_ratio=0.5)
    made.add_material("muscle", density=1000, youngs_modulus=1e5, damping_ratio=0.5)
    cells = np.ones((4, 2, 1), int)
    cells[:, 1] = 2
    made.add_voxels("beam", cells, size=0.1, palette={1: "fat", 2: "muscle"}, position=[0, 1, 0])
    return made


def test_an_actuator_has_the_keys_of_files(robot: aspic.Scene) -> None:
    phases = np.linspace(0, 1, 8).reshape(4, 2, 1)
    mask = np.ones((4, 2, 1), bool)
    mask[0] = False
    path = robot.add_actuator("legs", material="muscle", volume_change=0.5, frequency=2.0, phase=phases)
    assert path == "actuator[legs]"
    robot.add_actuator(
        "back",
        body=["beam"],
        box=([-0.2, -0.1, -0.05], [0.0, 0.1, 0.05]),
        voxels=mask,
        springs=["structural"],
        axis="x",
        amplitude=0.2,
        phase={"along": "x", "wavelength": 0.5},
        start=0.5,
        ramp=0.25,
    )
    robot.add_actuator("table", table=[[0, 0], [0.5, 1], [1, 0]], phase=0.25)
    assert robot["actuator[legs].volume-change"] == 0.5 and robot["actuator[legs].frequency"] == 2.0
    assert robot["actuator[legs].phase.cells"].startswith("4 2 1: ")
    assert robot["actuator[back].axis"] == "x" and robot["actuator[back].phase.wavelength"] == 0.5
    assert robot["actuator[table].signal"] == "table" and robot["actuator[table].phase.offset"] == 0.25
    assert aspic.Scene(robot.toml, "robot") == robot
    robot["actuator[legs].frequency"] = 3.0
    assert robot.copy()["actuator[0].frequency"] == 3.0


def test_what_is_wrong_is_said(robot: aspic.Scene) -> None:
    before = robot.copy()
    for values, words in (
        ({"material": "muscel"}, "did you mean 'muscle'"),
        ({"body": "beem"}, "beem"),
        ({"signal": "sin"}, "did you mean 'sine'"),
        ({"phase": np.full((4, 2, 1), np.nan)}, "phase: number 0 of it is nan"),
        ({"phase": np.zeros((4, 2))}, "phase: it must be an array with three axes"),
        ({"voxels": np.ones((4, 2, 1))}, "mask: it must be an array of truth values"),
    ):
        with pytest.raises(aspic.SceneError, match=words):
            robot.add_actuator("legs", **values)  # type: ignore[arg-type]
        assert robot == before
    with pytest.raises(aspic.UsageError, match="phase: an array of numbers"):
        robot.add_actuator("legs", phase=[[[object()]]])  # type: ignore[list-item]


@pytest.mark.parametrize("backend", backends)
def test_inputs_drive_actuators_by_name(robot: aspic.Scene, backend: str) -> None:
    robot.add_actuator("grow", material="muscle", amplitude=0.2, signal="input")
    robot.add_actuator("wave", material="fat", amplitude=0.1)
    robot.add_actuator("bend", material="fat", amplitude=0.2, axis="x", signal="input")
    sim = simulation(robot, backend)
    assert list(sim.inputs) == ["grow", "bend"] and dict(sim.inputs) == {"grow": 0.0, "bend": 0.0}
    sim.inputs["bend"] = 0.5
    sim.inputs = {"grow": 1.0}  # type: ignore[assignment]
    assert dict(sim.inputs) == {"grow": 1.0, "bend": 0.5} and sim.channels == (1.0, 0.5)
    sim.step(300)
    length = np.ptp(sim["beam"].positions[:, 0])
    assert length > 0.42
    sim.save_inputs("inputs.toml")
    again = simulation(robot, "reference")
    again.replay("inputs.toml")
    again.step(300)
    assert again.hash == sim.hash
    for name, words in (("gro", "did you mean 'grow'"), ("x", "the inputs are grow, bend")):
        with pytest.raises(aspic.UsageError, match=words):
            sim.inputs[name] = 1.0
    with pytest.raises(aspic.UsageError, match="finite"):
        sim.inputs["grow"] = float("nan")
    with pytest.raises(aspic.UsageError):
        sim.channels = (0.0, 0.0, 0.0)


def test_controls_are_inputs_by_step(robot: aspic.Scene) -> None:
    robot.add_actuator("grow", material="muscle", amplitude=0.2, signal="input")
    robot.add_actuator("bend", material="fat", amplitude=0.2, axis="x", signal="input")
    time = np.arange(60) / 60
    controls = np.stack([np.sin(6 * time), time], axis=1)
    sim, other = simulation(robot, "cpu"), simulation(robot, "cpu")
    record = sim.run(every=0.02, record=["beam.center-of-mass"], controls=controls)
    assert len(record.time) == 4 and sim.steps == 60
    for row in controls:
        other.channels = row
        other.step()
    assert other.hash == sim.hash and dict(sim.inputs) == {"grow": controls[-1, 0], "bend": controls[-1, 1]}
    for wrong, words in ((np.zeros((5, 3)), r"\(steps, 2\), of grow, bend"), (np.zeros(5), r"\(steps, 2\)")):
        with pytest.raises(aspic.UsageError, match=words):
            sim.run(controls=wrong)
    with pytest.raises(aspic.UsageError, match="5 rows"):
        sim.run(steps=4, controls=np.zeros((5, 2)))


def test_work_is_booked(robot: aspic.Scene) -> None:
    robot.add_actuator("grow", material="muscle", amplitude=0.2, signal="input")
    sim = simulation(robot, "cpu")
    before: Any = sim.run(0.0, record=["energy", "actuator-work"])
    sim.inputs["grow"] = 1.0
    now: Any = sim.run(1.0, every=0.001, record=["energy", "actuator-work"])
    # The spring's energy is put in by the jump, which is before the first sample, and dampers take it.
    assert before["actuator-work"].tolist() == [0] and now["actuator-work"].shape == (1001,)
    assert before["energy"].elastic[-1] < 1e-9 < now["energy"].elastic[0]
    assert not now["actuator-work"].any() and now["energy"].total[-1] < now["energy"].total[0]
    batch = aspic.Batch([robot, robot])
    batch.step(10)
    batch[1].inputs["grow"] = 1.0
    out = batch.run(0.1, every=0.02, record=["actuator-work"])
    assert out["actuator-work"].shape == (2, 6) and not out["actuator-work"].any()
    robot["actuator[grow].signal"] = "sine"
    path: Any = simulation(robot, "cpu").run(2.0, every=0.01, record=["actuator-work"])
    assert path["actuator-work"][0] == 0 and path["actuator-work"][-1] > 0
    together = aspic.Batch(robot, count=2).run(2.0, every=0.01, record=["actuator-work"])["actuator-work"]
    assert np.array_equal(together[1], path["actuator-work"])
    still: Any = simulation(aspic.load("cube-plane"), "cpu").run(0.1, record="actuator-work")
    assert not still["actuator-work"].any()


def test_instances_of_a_batch_have_inputs_of_their_own(robot: aspic.Scene) -> None:
    robot.add_actuator("grow", material="muscle", amplitude=0.2, signal="input")
    batch = aspic.Batch(robot, count=3)
    for number, instance in enumerate(batch):
        instance.inputs["grow"] = number / 2
    batch.step(100)
    for number, code in enumerate(batch.hash):
        alone = simulation(robot, "cpu")
        alone.inputs["grow"] = number / 2
        alone.step(100)
        assert alone.hash == code
    assert len(set(batch.hash)) == 3


def test_without_inputs_there_is_none() -> None:
    sim = aspic.Simulation("worm", "cpu")
    assert len(sim.inputs) == 0 and repr(sim.inputs) == "{}"
    with pytest.raises(aspic.UsageError, match=re.escape('no actuator has signal = "input"')):
        sim.inputs["wave"] = 1.0


@pytest.mark.parametrize("name", ["worm", "walker"])
def test_robots_crawl(name: str) -> None:
    sim = simulation(aspic.load(name), "cpu")
    run: Any = sim.run(6.0, record=["center-of-mass"])
    moved = run["center-of-mass"][-1] - run["center-of-mass"][0]
    assert moved[0] > 0.4 and abs(moved[2]) < 0.2 * moved[0]
