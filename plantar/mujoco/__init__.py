"""Plantar skin in anyone's MuJoCo simulation. Needs the extra `sim`.

>>> import mujoco
>>> from plantar.mujoco import Skin
>>> spec = mujoco.MjSpec.from_string('''<mujoco><worldbody><geom type="plane" size="1 1 1"/>
...   <body name="foot" pos="0 0 0.03"><freejoint/><geom type="box" size=".1 .05 .03" mass="10"/></body>
... </worldbody></mujoco>''')
>>> skin = Skin(body="foot")
>>> skin.edit(spec)
>>> model = spec.compile()
>>> feel = skin.bind(model)
>>> data = mujoco.MjData(model)
>>> mujoco.mj_step(model, data, 100)
>>> reading = feel(data)
>>> bool(abs(reading.force.sum() - reading.wrench[2]) < 1e-9), round(float(reading.wrench[2]))
(True, 98)
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from plantar.mujoco.bound_skin import BoundSkin, SkinReading
    from plantar.mujoco.foam import Foam
    from plantar.mujoco.foam_skins import FoamSkins
    from plantar.mujoco.layer import ElasticLayer
    from plantar.mujoco.skin import Skin
    from plantar.mujoco.skins import Skins

__all__ = ["BoundSkin", "ElasticLayer", "Foam", "FoamSkins", "Skin", "SkinReading", "Skins"]

if not TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        """Load a public name at first use: `plantar.sim` needs parts of this package, and not all of it."""
        if name not in __all__:
            raise AttributeError(f"module 'plantar.mujoco' has no attribute {name!r}")
        from plantar.common.optional_library import need_libraries

        need_libraries("sim", "mujoco", "scipy")
        homes = {"ElasticLayer": "layer", "Foam": "foam", "FoamSkins": "foam_skins", "Skin": "skin", "Skins": "skins"}
        home = homes.get(name, "bound_skin")
        return getattr(import_module(f"plantar.mujoco.{home}"), name)
