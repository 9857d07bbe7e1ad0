"""`quat_xyzw` of URDF 1.1 gives the same simulated arm as `rpy`."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("pybullet")

from smachac import sim

URDF = """<robot name="r" version="1.1"><link name="base"/><link name="a"/><link name="tool"/>
<joint name="j" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
<origin xyz="0 0 0.1" ROTATION/><limit lower="-1.5" upper="1.5" effort="10" velocity="1"/></joint>
<joint name="f" type="fixed"><parent link="a"/><child link="tool"/><origin xyz="0 0 0.3"/></joint>
</robot>"""
ARM = "name: r\nurdf: arm.urdf\narms: {arm: {joints: [j], tool: tool, home: [0.5]}}\n"
AHEAD = [[0.3, 0.0, 0.1], [0.0, 0.70710678, 0.0, 0.70710678]]


@pytest.mark.parametrize(
    "rotation", ['quat_xyzw="0 0.70710678 0 0.70710678"', 'rpy="0 1.5707963267948966 0"']
)
def test_both_rotations_are_one_arm(tmp_path: Path, rotation: str) -> None:
    (tmp_path / "arm.urdf").write_text(URDF.replace("ROTATION", rotation))
    (tmp_path / "arm.yml").write_text(ARM)
    with sim.World(robot=str(tmp_path / "arm.yml")) as world:
        assert world.arms[0].solve_ik(AHEAD) == pytest.approx([0.0], abs=1e-3)
        # The only joint does not move this position: no step of the search changes it.
        assert world.arms[0].solve_ik([[0.0, 0.0, 0.4], [0.0, 0.0, 0.0, 1.0]]) is None
        assert world.arms[0].move_to_joints([1.0]).outcome == "succeeded"
