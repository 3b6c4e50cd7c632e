"""Who may use the console."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from weaver_console import user_command
from weaver_console.access import COOKIE, VALID_S, Access, Role, UserStore, is_loopback
from weaver_console.access.gate import MOST_FAILURES
from weaver_console.access.rate_limit import RateLimit
from weaver_console.database import Database
from weaver_shared.errors import ConfigurationError, InputError
from weaver_shared.messages import CommandName

PASSWORD = "six legs good"


class Wall:
    now = 1_000_000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def wall() -> Wall:
    return Wall()


@pytest.fixture(scope="module")
def staffed() -> Database:
    """Anna operates, ben watches, ada looks after the users."""
    database = Database(None)
    users = UserStore(database)
    for name, role in (("anna", Role.OPERATOR), ("ben", Role.VIEWER), ("ada", Role.ADMIN)):
        users.add(name, role, PASSWORD)
    return database


@pytest.fixture
def guarded(staffed: Database, wall: Wall) -> Access:
    return Access(host="0.0.0.0", database=staffed, now=wall)


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.1.5", "::", "robot.local"])
def test_another_address_than_loopback_needs_users(host: str, staffed: Database):
    with pytest.raises(ConfigurationError, match="without users"):
        Access(host=host)
    assert not Access(host=host, database=staffed).open


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", "localhost", "127.8.8.8"])
def test_loopback_needs_none_unless_told(host: str, staffed: Database):
    assert is_loopback(host)
    identity = Access(host=host).identify({}, {})
    assert identity is not None
    assert identity.administers
    assert Access(host=host, database=staffed, guarded=True).identify({}, {}) is None


def test_a_session_lasts_a_day_and_over_a_restart(guarded: Access, staffed: Database, wall: Wall):
    entered = guarded.log_in("anna", PASSWORD, "10.0.0.7")
    assert entered is not None
    cookies = {COOKIE: entered[1]}
    for access in (guarded, Access(host="0.0.0.0", database=staffed, now=wall)):
        assert access.identify({}, cookies) == entered[0]
    wall.now += VALID_S + 1
    assert guarded.identify({}, cookies) is None


def test_logging_out_ends_the_session_everywhere(guarded: Access):
    entered = guarded.log_in("anna", PASSWORD, "10.0.0.7")
    assert entered is not None
    guarded.log_out({COOKIE: entered[1]})
    assert guarded.identify({}, {COOKIE: entered[1]}) is None


@given(st.text(max_size=100), st.text(max_size=100))
def test_made_up_cookies_and_tokens_do_not_admit(cookie: str, token: str):
    access = Access(host="127.0.0.1", database=STAFFED, guarded=True)
    assert access.identify({"authorization": f"Bearer {token}"}, {}) is None
    assert access.identify({}, {COOKIE: cookie}) is None


STAFFED = Database(None)
UserStore(STAFFED).add("anna", Role.OPERATOR, PASSWORD)


@pytest.mark.parametrize("name", ["anna", "nobody", "", "'; drop table user; --"])
def test_only_the_right_name_with_the_right_password_comes_in(guarded: Access, name: str):
    assert guarded.log_in(name, "six legs bad", "10.0.0.7") is None
    if name != "anna":
        assert guarded.log_in(name, PASSWORD, "10.0.0.7") is None
    assert guarded.users.find("anna") is not None


def test_ten_wrong_passwords_block_that_address_for_a_while(guarded: Access, wall: Wall):
    for _ in range(MOST_FAILURES):
        assert not guarded.blocked("10.0.0.7")
        assert guarded.log_in("anna", "a wrong guess", "10.0.0.7") is None
    assert guarded.blocked("10.0.0.7")
    assert not guarded.blocked("10.0.0.8")
    wall.now += 61.0
    assert not guarded.blocked("10.0.0.7")
    assert guarded.log_in("anna", PASSWORD, "10.0.0.7") is not None


def test_a_token_is_its_users_until_it_is_removed():
    users = UserStore(Database(None))
    users.add("anna", Role.OPERATOR, PASSWORD)
    token = users.add_token("anna")
    access_by = users.by_token(token)
    assert access_by is not None
    assert access_by.name == "anna"
    assert users.remove_tokens("anna") == 1
    assert users.by_token(token) is None


def test_a_new_password_ends_sessions_and_tokens():
    database = Database(None)
    users = UserStore(database)
    users.add("anna", Role.ADMIN, PASSWORD)
    access = Access(host="127.0.0.1", database=database, guarded=True)
    entered, token = access.log_in("anna", PASSWORD, ""), users.add_token("anna")
    assert entered is not None
    users.set_password("anna", "eight legs better")
    assert access.identify({}, {COOKIE: entered[1]}) is None
    assert users.by_token(token) is None
    assert users.check("anna", PASSWORD) is None
    assert users.check("anna", "eight legs better") is not None


def test_no_secret_is_kept_readable(tmp_path: Path):
    database = Database(tmp_path / "console.sqlite3")
    users = UserStore(database)
    users.add("anna", Role.ADMIN, PASSWORD)
    token = users.add_token("anna")
    database.close()
    kept = b"".join(file.read_bytes() for file in tmp_path.iterdir())
    assert PASSWORD.encode() not in kept
    assert token.encode() not in kept
    assert (tmp_path / "console.sqlite3").stat().st_mode & 0o077 == 0


def test_the_last_admin_stays():
    users = UserStore(Database(None))
    users.add("ada", Role.ADMIN, PASSWORD)
    for attempt in (lambda: users.remove("ada"), lambda: users.set_role("ada", Role.VIEWER)):
        with pytest.raises(InputError, match="only admin"):
            attempt()


@pytest.mark.parametrize("password", ["", "short", "x" * 257])
def test_a_password_too_short_or_too_long_is_refused(password: str):
    with pytest.raises(InputError, match="8 to 256"):
        UserStore(Database(None)).add("anna", Role.OPERATOR, password)


def test_viewers_may_stop_and_nothing_else(guarded: Access):
    ben, anna = guarded.users.find("ben"), guarded.users.find("anna")
    assert ben is not None
    assert anna is not None
    assert [name for name in CommandName if not ben.refusal(name)] == [CommandName.STOP]
    assert not any(anna.refusal(name) for name in CommandName)


def test_a_database_from_before_there_were_users_gets_them(tmp_path: Path):
    file = tmp_path / "console.sqlite3"
    old = Database(file)
    old.write("insert into mission values ('walk', '[[1, 2]]', 'anna', 'weaver', 1.0)", [()])
    for table in ("user", "session", "token"):
        old.write(f"drop table {table}", [()])
    old.write("pragma user_version = 1", [()])
    old.close()
    new = Database(file)
    assert new.read("select name from mission") == [("walk",)]
    assert not UserStore(new).exist
    new.close()


def test_users_are_looked_after_from_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    secret = tmp_path / "secret"
    secret.write_text(f"{PASSWORD}\n")
    data = ["--data", str(tmp_path)]
    assert user_command.main([*data, "add", "ada", "--role", "admin", "--password-file", str(secret)]) == 0
    assert user_command.main([*data, "add", "ben", "--role", "viewer", "--password-file", str(secret)]) == 0
    assert user_command.main([*data, "token", "ben"]) == 0
    capsys.readouterr()
    user_command.main([*data, "list"])
    listed = capsys.readouterr().out.splitlines()
    assert [line.split()[:2] for line in listed] == [["ada", "admin"], ["ben", "viewer"]]
    user_command.main([*data, "remove", "ben"])
    with pytest.raises(InputError, match="no user 'ben'; known are ada"):
        user_command.main([*data, "role", "ben", "operator"])
    with pytest.raises(InputError, match="known are viewer, operator, admin"):
        user_command.main([*data, "role", "ada", "queen"])


def test_a_limit_fills_again_and_keeps_the_askers_apart(wall: Wall):
    limit = RateLimit(rate=2.0, burst=4.0, now=wall)
    assert [limit.spend("a") for _ in range(5)] == [True] * 4 + [False]
    assert limit.spend("b")
    wall.now += 1.0
    assert [limit.spend("a") for _ in range(3)] == [True, True, False]


@pytest.mark.parametrize(
    ("headers", "allowed"),
    [
        ({"host": "127.0.0.1:8080"}, True),
        ({"host": "localhost:8080", "origin": "http://localhost:8080"}, True),
        ({"host": "[::1]:8080", "origin": "http://[::1]:8080"}, True),
        ({"host": "127.0.0.1:8080", "origin": "http://evil.example"}, False),
        ({"host": "127.0.0.1:8080", "origin": "http://127.0.0.1:9999"}, False),
        ({"host": "127.0.0.1:8080", "origin": "null"}, False),
        ({"host": "evil.example:8080", "origin": "http://evil.example:8080"}, False),
        ({}, False),
    ],
)
def test_only_our_own_origin_on_a_loopback_name(headers: dict[str, str], allowed: bool):
    assert Access(host="127.0.0.1").origin_allowed(headers) is allowed
