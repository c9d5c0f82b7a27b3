"""The scenarios in the manual are good ones."""

from __future__ import annotations

import re
from pathlib import Path

from mdlcad.language import read_device
from mdlcad.scenario.file import GridWalk, load_scenario
from mdlcad.scenario.world import make_world

ROOT = Path(__file__).parents[2]


def test_every_scenario_in_the_manual_can_be_run(tmp_path: Path) -> None:
    blocks = re.findall(r"```toml\n(.*?)```", (ROOT / "docs" / "scenarios.md").read_text(), re.DOTALL)
    assert len(blocks) == 2
    for number, block in enumerate(blocks):
        path = tmp_path / f"{number}.toml"
        path.write_text(block)
        scenario = load_scenario(path)
        example = "mazerobot" if isinstance(scenario, GridWalk) else "lock"
        assert not make_world(scenario, read_device(ROOT / "examples" / f"{example}.mdl"), str(path)).finished
