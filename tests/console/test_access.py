"""Who may use the console."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from weaver_console.access import MOST_FAILURES, VALID_S, Access, is_loopback
from weaver_shared.errors import ConfigurationError

PASSWORD = "six legs good"


class Wall:
    now = 1_000_000.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def wall() -> Wall:
    return Wall()


@pytest.fixture
def guarded(wall: Wall) -> Access:
    return Access(host="127.0.0.1", password=PASSWORD, now=wall)


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.1.5", "::", "robot.local"])
def test_another_address_than_loopback_needs_a_password(host: str):
    with pytest.raises(ConfigurationError, match="without a password"):
        Access(host=host)
    assert not Access(host=host, password=PASSWORD).open


@pytest.mark.parametrize("host", ["127.0.0.1", "::1", "localhost", "127.8.8.8"])
def test_loopback_needs_none(host: str):
    assert is_loopback(host)
    assert Access(host=host).admits(None)


def test_a_cookie_admits_until_it_expires_and_after_a_restart_too(guarded: Access, wall: Wall):
    cookie = guarded.issue_cookie()
    assert guarded.admits(cookie)
    assert Access(host="127.0.0.1", password=PASSWORD, now=wall).admits(cookie)
    assert not Access(host="127.0.0.1", password="another one", now=wall).admits(cookie)
    wall.now += VALID_S + 1
    assert not guarded.admits(cookie)


@given(st.text(max_size=200))
def test_a_made_up_cookie_does_not_admit(cookie: str):
    assert not GUARDED.admits(cookie)


GUARDED = Access(host="127.0.0.1", password=PASSWORD)


def test_a_cookie_whose_expiry_was_put_off_does_not_admit(guarded: Access):
    expiry, _, signature = guarded.issue_cookie().partition(".")
    assert not guarded.admits(f"{int(expiry) + 1}.{signature}")
    assert not guarded.admits(None)


def test_ten_wrong_passwords_block_for_a_minute(guarded: Access, wall: Wall):
    for _ in range(MOST_FAILURES):
        assert not guarded.blocked
        assert not guarded.check_password("guess")
    assert guarded.blocked
    wall.now += 61.0
    assert not guarded.blocked
    assert guarded.check_password(PASSWORD)


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
