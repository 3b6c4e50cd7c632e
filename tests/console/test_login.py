"""A console that asks who comes: before the login, as viewer, as operator, as admin."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from running_console import PASSWORD, Console, Page
from websockets.exceptions import ConnectionClosed, InvalidStatus
from wire_robot import WireRobot

from weaver_console.access import Role
from weaver_shared.bus import MemoryBus
from weaver_shared.messages import CommandName

LOGIN_NEEDED = 4001


def test_nothing_is_served_before_the_login(guarded: Console):
    for path in ("/api/robots", "/viser/page-0001/", "/assets/page-1.js", "/api/users", "/api/events"):
        assert guarded.http.get(path).status_code == 401
    front = guarded.http.get("/")
    assert front.status_code == 401
    assert "Password" in front.text
    with guarded.connect("/ws?page=page-0001") as socket, pytest.raises(ConnectionClosed) as closed:
        socket.recv(timeout=10.0)
    assert closed.value.rcvd is not None
    assert closed.value.rcvd.code == LOGIN_NEEDED
    with pytest.raises(InvalidStatus):
        guarded.connect("/viser/page-0001/")
    assert guarded.http.get("/api/health").status_code == 200


def test_the_right_password_opens_the_page_under_the_users_own_name(guarded: Console):
    wrong = guarded.http.post("/api/login", json={"name": "anna", "password": "wrong"})
    assert wrong.status_code == 401
    answer = guarded.http.post("/api/login", json={"name": "anna", "password": PASSWORD})
    assert answer.json() == {"status": "ok", "name": "anna", "role": "operator"}
    assert "HttpOnly" in answer.headers["set-cookie"]
    assert "SameSite=strict" in answer.headers["set-cookie"]
    assert guarded.http.get("/api/robots").status_code == 200
    headers = guarded.log_in("anna")
    with guarded.page(operator="ben", additional_headers=headers) as socket:
        hello = Page(socket).hear("hello")
        assert (hello["operator"], hello["user"], hello["role"]) == ("anna", "anna", "operator")
        with guarded.page(page="page-0002", additional_headers=headers) as second:
            assert Page(second).hear("hello")["operator"] == "anna 2"


def test_a_token_lets_a_program_in(guarded: Console):
    headers = {"Authorization": f"Bearer {guarded.users.add_token('anna')}"}
    assert guarded.http.get("/api/robots", headers=headers).status_code == 200
    with guarded.page(additional_headers=headers) as socket:
        assert Page(socket).hear("hello")["user"] == "anna"
    assert guarded.http.get("/api/robots", headers={"Authorization": "Bearer weaver_guess"}).status_code == 401


def test_the_login_form_leads_to_the_page_or_says_what_is_wrong(guarded: Console):
    form = {"name": "anna", "password": "<b>wrong"}
    refused = guarded.http.post("/api/login", data=form)
    assert refused.status_code == 401
    assert "The name or the password is wrong" in refused.text
    answer = guarded.http.post("/api/login", data={**form, "password": PASSWORD}, follow_redirects=False)
    assert (answer.status_code, answer.headers["location"]) == (303, "/")


@pytest.mark.parametrize(
    "body",
    [b"", b"{", b"[]", b'{"name":"anna","password":1}', b'{"name":null,"password":"x"}', b"[" * 5000, b"\xff"],
)
def test_a_malformed_login_is_answered(guarded: Console, body: bytes):
    assert guarded.http.post("/api/login", content=body).status_code == 422


def test_guessing_is_slowed_down(guarded: Console):
    codes = [guarded.http.post("/api/login", json={"name": "anna", "password": "guess"}).status_code for _ in range(11)]
    assert codes == [401] * 10 + [429]
    assert guarded.http.post("/api/login", json={"name": "anna", "password": PASSWORD}).status_code == 429


def test_a_viewer_watches_and_stops_but_does_not_command(guarded: Console, robot: WireRobot):
    with guarded.page(additional_headers=guarded.log_in("ben")) as socket:
        page = Page(socket)
        page.select(robot)
        robot.step()
        page.hear("value", key="tele/state")
        for name in (CommandName.TAKE_CONTROL, CommandName.STAND, CommandName.START_RECORDING):
            answer = page.command(name)
            assert not answer["accepted"]
            assert "viewer" in answer["reason"]
        page.say(type="teleop", forward=1.0, left=0.0, turn=0.0, dead_man=True)
        assert "viewer" in page.hear("error")["reason"]
        page.say(type="retain")
        assert page.command(CommandName.STOP)["accepted"]
    assert [command.command for command in robot.commands] == [CommandName.STOP]


def test_a_viewer_keeps_and_deletes_nothing(guarded: Console):
    ben, anna = guarded.log_in("ben"), guarded.log_in("anna")
    mission = {"waypoints": [{"x": 1.0, "y": 2.0}]}
    assert guarded.http.put("/api/missions/walk", json=mission, headers=ben).status_code == 403
    assert guarded.http.put("/api/missions/walk", json=mission, headers=anna).status_code == 200
    assert guarded.http.delete("/api/missions/walk", headers=ben).status_code == 403
    assert len(guarded.http.get("/api/missions", headers=ben).json()["missions"]) == 1


def test_only_an_admin_looks_after_the_users(guarded: Console):
    ada, anna = guarded.log_in("ada"), guarded.log_in("anna")
    assert guarded.http.get("/api/users", headers=anna).status_code == 403
    assert (
        guarded.http.put("/api/users/eve", json={"role": "admin", "password": PASSWORD}, headers=anna).status_code
        == 403
    )
    assert guarded.http.delete("/api/users/ben", headers=anna).status_code == 403
    assert guarded.http.put("/api/users/eve", json={"password": PASSWORD}, headers=ada).status_code == 200
    users = guarded.http.get("/api/users", headers=ada).json()["users"]
    assert {user["name"]: user["role"] for user in users}["eve"] == "viewer"
    assert all("password" not in user for user in users)
    short = guarded.http.put("/api/users/eve", json={"password": "short"}, headers=ada)
    assert (short.status_code, short.json()["error"]) == (422, "a password has 8 to 256 characters")
    assert guarded.http.delete("/api/users/ada", headers=ada).status_code == 422
    assert guarded.http.delete("/api/users/eve", headers=ada).status_code == 200
    assert any("eve has been removed" in event.text for event in guarded.hub.link.events.latest())


def test_who_is_removed_is_shown_out_at_once(guarded: Console, robot: WireRobot):
    with guarded.page(additional_headers=guarded.log_in("anna")) as socket:
        page = Page(socket)
        page.select(robot)
        guarded.users.remove("anna")
        with pytest.raises(ConnectionClosed) as closed:
            page.hear("nothing more")
    assert closed.value.rcvd is not None
    assert closed.value.rcvd.code == LOGIN_NEEDED


def test_another_role_counts_from_then_on(guarded: Console, robot: WireRobot):
    with guarded.page(additional_headers=guarded.log_in("anna")) as socket:
        page = Page(socket)
        page.select(robot)
        guarded.users.set_role("anna", Role.VIEWER)
        assert page.hear("role")["role"] == "viewer"
        assert not page.command(CommandName.TAKE_CONTROL)["accepted"]


def test_a_page_that_floods_is_told_to_slow_down_and_may_still_stop(console: Console, robot: WireRobot):
    with console.page() as socket:
        page = Page(socket)
        page.select(robot)
        for number in range(100):
            page.say(type="command", id=str(number), command="set_gait", name="tripod")
        refused = page.hear("answer", accepted=False, reason="more than 30 commands a second; slow down")
        assert int(refused["id"]) >= 60
        assert page.command(CommandName.STOP)["accepted"]


@pytest.fixture
def behind_proxy(bus: MemoryBus, page_folder: Path) -> Iterator[Console]:
    console = Console(bus, page_folder, users={"anna": Role.OPERATOR}, proxies=("127.0.0.1",))
    yield console
    console.close()


def test_a_trusted_proxy_tells_who_it_forwards(behind_proxy: Console):
    forwarded = {"X-Forwarded-For": "203.0.113.9", "X-Forwarded-Proto": "https", "Host": "robots.example"}
    for _ in range(10):
        behind_proxy.http.post("/api/login", json={"name": "anna", "password": "guess"}, headers=forwarded)
    login = {"name": "anna", "password": PASSWORD}
    assert behind_proxy.http.post("/api/login", json=login, headers=forwarded).status_code == 429
    other = {**forwarded, "X-Forwarded-For": "203.0.113.10"}
    answer = behind_proxy.http.post("/api/login", json=login, headers=other)
    assert answer.status_code == 200
    assert "Secure" in answer.headers["set-cookie"]
    assert "max-age" in answer.headers["strict-transport-security"]


def test_others_are_not_believed_whom_they_forward(guarded: Console):
    for number in range(10):
        headers = {"X-Forwarded-For": f"203.0.113.{number}", "X-Forwarded-Proto": "https"}
        answer = guarded.http.post("/api/login", json={"name": "anna", "password": "guess"}, headers=headers)
        assert "strict-transport-security" not in answer.headers
    assert guarded.http.post("/api/login", json={"name": "anna", "password": PASSWORD}).status_code == 429


def test_a_body_larger_than_any_of_ours_is_refused_told_or_not(console: Console):
    large = b"x" * (256 * 1024 + 1)
    assert console.http.put("/api/missions/walk", content=large).status_code == 413
    assert console.http.put("/api/missions/walk", content=iter([large[:200_000]] * 3)).status_code == 413
