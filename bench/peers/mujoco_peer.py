"""The lattice in MuJoCo's flex: a flex of dimension one whose elements are the springs, each with MuJoCo's own passive
stiffness and damping of edges; every particle is a body that slides along three axes."""
from peer import converse

import mujoco


class Peer:
    def __init__(self, lattice):
        self.lattice = lattice
        pairs, _ = lattice.springs()
        self.springs = len(pairs)
        self.rest = lattice.positions(1.0)
        bodies = "".join(
            f'<body name="p{i}" pos="{x!r} {y!r} {z!r}"><inertial pos="0 0 0" mass="{lattice.mass!r}" diaginertia="1 1 1"/>'
            '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/><joint type="slide" axis="0 0 1"/></body>'
            for i, (x, y, z) in enumerate(self.rest.tolist()))
        names = " ".join(f"p{i}" for i in range(len(self.rest)))
        self.model = mujoco.MjModel.from_xml_string(
            f'<mujoco><option timestep="{lattice.timestep!r}" gravity="0 {-lattice.gravity!r} 0" integrator="Euler">'
            '<flag constraint="disable" contact="disable"/></option>'
            f"<worldbody>{bodies}</worldbody><deformable>"
            f'<flex name="cube" dim="1" body="{names}" element="{" ".join(map(str, pairs.ravel()))}">'
            '<contact selfcollide="none" contype="0" conaffinity="0"/>'
            f'<edge stiffness="{lattice.stiffness!r}" damping="{lattice.damping!r}"/></flex></deformable></mujoco>')
        self.data = mujoco.MjData(self.model)

    def hello(self):
        return {"name": "mujoco", "version": mujoco.__version__, "threads": 1, "integrator": "symplectic-euler",
                "damping": self.lattice.damping, "deviation": 0.0}

    def load(self):
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[:] = (self.lattice.start() - self.rest).ravel()

    def advance(self, steps):
        mujoco.mj_step(self.model, self.data, nstep=steps)

    def positions(self):
        return self.rest + self.data.qpos.reshape(-1, 3)


converse(Peer)
