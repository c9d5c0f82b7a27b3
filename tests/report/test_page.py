"""report.html: one file, nothing from elsewhere, readable without eyes, and what does not hold comes first."""

import json
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from lxml import html

from mdlcad.artefact import load
from mdlcad.errors import UsageError
from mdlcad.flow.schemas import schema
from mdlcad.report.margins import margin_rows
from mdlcad.report.page import page, write_page
from mdlcad.report.report import Report, Stopped, TiltReport
from tests.report.folders import BROKEN, folder, proof
from tests.report.schema_check import problems


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> Path:
    return folder(tmp_path_factory.mktemp("page") / "small")


@pytest.fixture(scope="module")
def broken(tmp_path_factory) -> Path:
    words = ("overlap at (1.00, 2.00): rung.a, rung.b: they share 0.750 mm2 as assembled",)
    return folder(tmp_path_factory.mktemp("page") / "broken", rules=BROKEN, failures=words)


def text_of(node) -> str:
    return " ".join(node.text_content().split())


def test_it_needs_no_other_file_and_no_network(whole):
    words = page(whole)
    root = html.document_fromstring(words)
    assert not root.xpath("//script | //link | //iframe | //object | //embed")
    assert all(source.startswith("data:") for source in root.xpath("//@src"))
    assert not re.search(r"https?://|//[a-z]|@import|url\(", re.sub(r"base64,[^\"]*", "", words))
    targets = [target for target in root.xpath("//a/@href") if not target.startswith("#")]
    assert targets
    assert all((whole / target).is_file() for target in targets)


def test_headings_tables_and_pictures_can_be_read_aloud(whole):
    root = html.document_fromstring(page(whole))
    assert root.get("lang") == "en"
    assert len(root.xpath("//h1")) == 1
    levels = [int(node.tag[1]) for node in root.xpath("//h1 | //h2 | //h3")]
    assert all(after - before <= 1 for before, after in pairwise(levels))
    assert all(node.get("alt") for node in root.xpath("//img"))
    assert root.xpath("//*[local-name()='svg']")
    assert all(node.get("aria-label") for node in root.xpath("//*[local-name()='svg']"))
    for table in root.xpath("//table"):
        assert all(row.xpath("./th[@scope='row']") for row in table.xpath("./tbody/tr"))
        assert all(cell.get("scope") == "col" for cell in table.xpath("./thead/tr/th"))
    sections = set(root.xpath("//section/@id"))
    assert {link.removeprefix("#") for link in root.xpath("//nav/a/@href")} == sections


def test_it_says_what_came_out_with_the_report_s_own_numbers(whole):
    root = html.document_fromstring(page(whole))
    report = json.loads((whole / "report.json").read_text())
    figures = {text_of(item.find("dt")): text_of(item.find("dd")) for item in root.xpath("//dl[@class='figures']/div")}
    assert figures["masses"] == str(report["masses"])
    assert figures["size"] == " × ".join(f"{value:.0f}" for value in report["extent_mm"]) + " mm"
    assert figures["mass"] == f"{report['bom']['mass_g']:.0f} g"
    files = text_of(root.get_element_by_id("files"))
    assert all(name in files and digest in files for name, digest in report["files"].items())
    assert len(report["bom"]["sheets"]) == len(root.xpath("//section[@id='bom']//table[1]/tbody")[0])
    assert "All of it holds" in text_of(root.xpath("//section[contains(@class, 'verdict')]")[0])


def test_what_does_not_hold_is_said_first_and_every_rule_has_its_count_and_worst(broken):
    root = html.document_fromstring(page(broken))
    first = root.xpath("//section")[0]
    assert "bad" in first.get("class")
    assert "Does not hold" in text_of(first)
    assert "0.750 mm2" in text_of(first)
    rows = {
        text_of(row.find("th")): [text_of(cell) for cell in row.findall("td")]
        for row in root.xpath("//section[@id='rules']//tbody/tr")
    }
    assert set(rows) == set(BROKEN.counts)
    assert {rule: int(cells[1]) for rule, cells in rows.items()} == BROKEN.counts
    assert "3.25" in rows["carrier_stiffness"][3] and "coupler.<y>" in rows["carrier_stiffness"][3]
    assert "warning" in rows["carrier_stiffness"][2]
    assert "fails" in rows["overlap"][2]
    assert "holds" in rows["min_wall"][2]


def test_a_rule_that_holds_says_how_near_its_limit_is(whole):
    root = html.document_fromstring(page(whole))
    report = json.loads((whole / "report.json").read_text())
    shown = text_of(root.get_element_by_id("rules"))
    assert "none found" in shown
    widest = max(report["bom"]["sheets"], key=lambda line: max(line["size_mm"]))
    assert f"{widest['size_mm'][0]:g} ×" in shown


def test_a_wrong_network_is_shown_with_what_it_did(tmp_path):
    reason = "the network does not behave as the program says"
    at = folder(
        tmp_path / "wrong",
        rules=None,
        network_proof=proof(wrong=2),
        stopped=Stopped("proof", reason),
        failures=(f"proof: {reason}",),
    )
    root = html.document_fromstring(page(at))
    assert "bad" in root.xpath("//section")[0].get("class")
    shown = text_of(root.get_element_by_id("proof"))
    assert "does not hold" in shown
    assert "6 of 8 checked" in shown
    assert "expected b[0]=1, got b[0]=?" in shown
    assert not root.xpath("//section[@id='plates' or @id='bom']")


def test_a_build_that_was_stopped_on_purpose_says_what_is_not_known(tmp_path):
    root = html.document_fromstring(page(folder(tmp_path / "part", rules=None)))
    first = root.xpath("//section")[0]
    assert "partial" in first.get("class")
    assert "design rules have not been checked" in text_of(first)
    assert "All of it holds" not in text_of(root)


def test_words_of_the_program_stay_words(whole):
    root = html.document_fromstring(page(whole))
    assert not root.xpath("//section[@id='asked']//b")
    assert "off & on" in text_of(root.get_element_by_id("asked"))


def test_only_the_timings_differ_between_runs(whole, tmp_path):
    again = folder(tmp_path / "small", seconds=7.25)
    drop = re.compile(r'(?s)<section id="time">.*?</section>')
    first, second = page(whole), page(again)
    assert first != second
    assert drop.sub("", first) == drop.sub("", second)


def test_a_truncated_file_is_named(tmp_path):
    at = folder(tmp_path / "small")
    (at / "drc.json").write_text("{")
    with pytest.raises(UsageError, match=r"drc\.json"):
        write_page(at)


@pytest.mark.parametrize("made", ["whole", "broken"])
def test_the_report_is_as_its_schema_says(made, request):
    rules = json.loads(schema("report"))
    report = json.loads((request.getfixturevalue(made) / "report.json").read_text())
    assert problems(report, rules, rules) == []


@pytest.mark.parametrize(
    ("key", "value"),
    [("masses", "six"), ("extent_mm", [1.0, 2.0]), ("files", {"a": 1}), ("stopped", {"stage": "proof"}), ("bom", 3)],
)
def test_a_report_of_another_shape_is_refused_by_the_schema(whole, key, value):
    rules = json.loads(schema("report"))
    report = json.loads((whole / "report.json").read_text())
    report[key] = value
    assert problems(report, rules, rules)


def test_a_device_whose_shuttles_tilt_says_how_far_and_whether_it_is_right(tmp_path):
    made = load(folder(tmp_path / "build"), "report.json", Report)
    assert made.extracted is not None
    tilts = TiltReport(0.0504, "free[0]", 4, 51, 0.346, 0.116)
    wrong = replace(made, tilting=replace(made.extracted, mismatches=1), tilts=tilts)
    for report, holds in ((wrong, False), (replace(wrong, tilting=made.extracted), True)):
        (row,) = (row for row in margin_rows(report, None, None, ()) if row.name == "tilting")
        assert row.holds is holds
        assert "0.050 rad at the most (free[0]); 4 of 51" in row.about
        assert "up to 0.35 F0, 0.12 on average" in row.about
