"""A name is looked up in the data that ships; whatever looks like a path is one."""

import pytest

from mdlcad.datafolder import find_data
from mdlcad.errors import UsageError


def test_a_folder_here_is_a_path_also_if_it_has_no_more_than_a_name(tmp_path, monkeypatch):
    (tmp_path / "mine").mkdir()
    monkeypatch.chdir(tmp_path)
    assert find_data("cells", "./mine", "").resolve() == tmp_path / "mine"
    with pytest.raises(UsageError, match="parametron"):
        find_data("cells", "mine", "")
    with pytest.raises(UsageError, match="no such file or folder"):
        find_data("cells", "./yours", "")
