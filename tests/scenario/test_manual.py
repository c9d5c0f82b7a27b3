"""The scenarios in the manual are good ones: each does what the manual says when it is run on a device."""

from __future__ import annotations

import re
from pathlib import Path

from mdlcad.artefact import from_json
from mdlcad.scenario import run_scenario
from mdlcad.scenario.file import GridWalk, load_scenario
from mdlcad.scenario.result import ScenarioResult
from mdlcad.scenario.run import RESULT
from tests.scenario.builds import QUICKLY, make_build

ROOT = Path(__file__).parents[2]


def test_every_scenario_in_the_manual_runs_as_it_says(tmp_path: Path) -> None:
    blocks = re.findall(r"```toml\n(.*?)```", (ROOT / "docs" / "scenarios.md").read_text(), re.DOTALL)
    assert len(blocks) == 2
    for number, block in enumerate(blocks):
        path = tmp_path / f"mine{number}.toml"
        path.write_text(block)
        scenario = load_scenario(path)
        example = "mazerobot" if isinstance(scenario, GridWalk) else "lock"
        build = make_build(example, tmp_path, QUICKLY)
        said: list[str] = []
        assert run_scenario(build, str(path), said.append) == []
        result = from_json((build / "scenarios" / path.stem / RESULT).read_bytes(), ScenarioResult)
        assert result.disagreements == 0
        if isinstance(scenario, GridWalk):
            assert result.end_cell == (2, 4)
        else:
            assert [d.actuators[0].label for d in result.decisions] == ["closed"] * 4
