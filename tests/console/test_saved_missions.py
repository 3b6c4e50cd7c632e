"""Missions kept by name: what is kept comes back, and what can not be kept is refused with a sentence."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from running_console import Console

from weaver_console.database import VERSION, Database
from weaver_console.missions import LONGEST_NAME, MissionStore
from weaver_shared.errors import InputError, ResourceError
from weaver_shared.messages import Waypoint

PLACES = (Waypoint(x=1.0, y=-0.5), Waypoint(x=2.25, y=0.0))
AREA = (Waypoint(x=4.0, y=0.0), Waypoint(x=5.0, y=0.0), Waypoint(x=5.0, y=1.0))
BODY = {"waypoints": [{"x": 1.0, "y": -0.5}], "operator": "anna", "robot": "sim-1"}


def test_a_mission_outlives_the_console(tmp_path: Path) -> None:
    path = tmp_path / "new" / "console.sqlite3"
    first = Database(path)
    MissionStore(first, lambda: 100.0).save(" round the lab ", PLACES, "anna", "sim-1")
    first.close()
    second = Database(path)
    (kept,) = MissionStore(second).all()
    second.close()
    assert (kept.name, kept.waypoints, kept.operator, kept.robot, kept.saved) == (
        "round the lab", PLACES, "anna", "sim-1", 100.0,
    )  # fmt: skip


def test_the_same_name_replaces_and_the_newest_comes_first() -> None:
    time = iter((1.0, 2.0, 3.0))
    store = MissionStore(Database(None), lambda: next(time))
    store.save("a", PLACES, "", "")
    store.save("b", PLACES, "", "")
    store.save("a", PLACES[:1], "", "")
    assert [(one.name, len(one.waypoints)) for one in store.all()] == [("a", 1), ("b", 2)]
    assert store.delete("a")
    assert not store.delete("a")


def test_what_a_mission_keeps_out_of_is_kept_with_it() -> None:
    database = Database(None)
    store = MissionStore(database)
    store.save("new", PLACES, "", "", areas=(AREA, AREA[::-1]))
    database.write("insert into mission values (?, ?, ?, ?, ?)", [("old", "[[1.0, 2.0]]", "", "", 0.0)])
    assert [(one.name, one.areas) for one in store.all()] == [("new", (AREA, AREA[::-1])), ("old", ())]


@pytest.mark.parametrize("name", ["", "  ", "x" * (LONGEST_NAME + 1), "two\nlines", "\x00"])
def test_a_name_that_can_not_be_read_is_refused(name: str) -> None:
    with pytest.raises(InputError, match="1 to 60 printable characters"):
        MissionStore(Database(None)).save(name, PLACES, "", "")


@given(name=st.text(min_size=1, max_size=LONGEST_NAME), x=st.floats(-1e5, 1e5), y=st.floats(-1e5, 1e5))
def test_whatever_is_accepted_comes_back_whole(name: str, x: float, y: float) -> None:
    store = MissionStore(Database(None))
    try:
        saved = store.save(name, (Waypoint(x=x, y=y),), name, name)
    except InputError:
        assert not name.strip() or not name.strip().isprintable()
    else:
        assert store.all() == [saved]


def test_a_file_of_another_version_is_left_alone(tmp_path: Path) -> None:
    path = tmp_path / "console.sqlite3"
    database = Database(path)
    database.write("pragma user_version = 99", [()])
    database.close()
    before = path.read_bytes()
    with pytest.raises(ResourceError, match=f"is of version 99, this console reads {VERSION}"):
        Database(path)
    assert path.read_bytes() == before


def test_a_file_that_is_no_database_is_named(tmp_path: Path) -> None:
    path = tmp_path / "console.sqlite3"
    path.write_text("no database at all " * 100)
    with pytest.raises(ResourceError, match=r"console\.sqlite3 can not be used.*--data"):
        Database(path)


def test_missions_over_http(console: Console) -> None:
    assert console.http.get("/api/missions").json() == {"missions": []}
    kept = console.http.put("/api/missions/round%20the%20lab", json=BODY)
    assert kept.status_code == 200
    (listed,) = console.http.get("/api/missions").json()["missions"]
    assert listed == kept.json()
    assert (listed["name"], listed["waypoints"], listed["operator"]) == ("round the lab", BODY["waypoints"], "anna")
    assert console.http.delete("/api/missions/round%20the%20lab").json() == {"deleted": True}
    assert console.http.delete("/api/missions/round%20the%20lab").status_code == 404


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"not json",
        b"[]",
        b'{"waypoints": []}',
        b'{"waypoints": [{"x": 1}]}',
        b'{"waypoints": [{"x": NaN, "y": 0}]}',
        b'{"waypoints": [{"x": 1e300, "y": 0}]}',
        b'{"waypoints": [{"x": 1, "y": 0}], "more": 1}',
        b'{"waypoints": [' + b",".join([b'{"x": 1, "y": 0}'] * 101) + b"]}",
    ],
)
def test_a_bad_mission_is_refused_and_nothing_is_kept(console: Console, body: bytes) -> None:
    answer = console.http.put("/api/missions/bad", content=body, headers={"content-type": "application/json"})
    assert answer.status_code == 422
    assert len(answer.json()["error"]) > 10
    assert console.http.get("/api/missions").json() == {"missions": []}
