"""A cube of 10³ particles hangs by its top and sags: MuJoCo, a flex of dimension one whose elements are the springs."""

import mujoco
from lattice import lattice

x, pairs, top = lattice(10, 4.0)
fixed = set(top.tolist())
slides = "".join(f'<joint type="slide" axis="{a}"/>' for a in ("1 0 0", "0 1 0", "0 0 1"))
bodies = "".join(
    f'<body name="p{i}" pos="{a!r} {b!r} {c!r}"><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>'
    f"{'' if i in fixed else slides}</body>"
    for i, (a, b, c) in enumerate(x.tolist())
)
names = " ".join(f"p{i}" for i in range(len(x)))
model = mujoco.MjModel.from_xml_string(
    f"""<mujoco>
<option timestep="0.001" gravity="0 -9.8 0" integrator="Euler"><flag constraint="disable" contact="disable"/></option>
<worldbody>{bodies}</worldbody>
<deformable>
<flex name="cube" dim="1" body="{names}" element="{" ".join(map(str, pairs.ravel()))}">
<contact selfcollide="none" contype="0" conaffinity="0"/><edge stiffness="2000" damping="60"/>
</flex>
</deformable>
</mujoco>"""
)
data = mujoco.MjData(model)


def advance(steps):
    mujoco.mj_step(model, data, nstep=steps)


def positions():
    mujoco.mj_kinematics(model, data)  # a step leaves those of its start
    return data.xpos[1:].copy()
