"""Who may say what on the bus: TLS, names with passwords, and the rules that a router keeps.

A robot speaks for itself alone and hears what is asked of it; a console hears all robots and asks them; a viewer hears
them and asks nothing. A process is told its own name by the environment, as it is the same for all of a computer.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from enum import StrEnum
from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from weaver_shared.errors import ConfigurationError
from weaver_shared.topics import ROOT

CERTIFICATE, USER, PASSWORD = "WEAVER_BUS_CERTIFICATE", "WEAVER_BUS_USER", "WEAVER_BUS_PASSWORD"
"""Environment: file with the certificate that signs the router's, and the process's own name and password."""

ENTERING = 10.0
"""s after which a router that is not there, or lets nobody in by this name, is an error."""

ALL_MESSAGES = (
    "put", "delete", "declare_subscriber", "query", "declare_queryable", "reply", "liveliness_token",
    "liveliness_query", "declare_liveliness_subscriber",
)  # fmt: skip
HEARING = (
    "declare_subscriber", "query", "reply", "liveliness_token", "liveliness_query", "declare_liveliness_subscriber",
)  # fmt: skip


class BusRole(StrEnum):
    ROBOT = "robot"
    CONSOLE = "console"
    VIEWER = "viewer"


class BusUser(BaseModel):
    """One line of the users' file; `robots` are the ids that a robot's computer speaks for."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    password: Annotated[str, Field(min_length=8, pattern=r"^[!-9;-~]+$")]  # a colon ends the name in Zenoh's own file
    role: BusRole
    robots: tuple[Annotated[str, Field(pattern=r"^[A-Za-z0-9_-]+$")], ...] = ()


Users = dict[Annotated[str, Field(pattern=r"^[A-Za-z0-9_.-]+$")], BusUser]


def read_users(path: Path) -> Users:
    """Raises ConfigurationError on a file that is not `{"NAME": {"password", "role", "robots"}, ...}`."""
    try:
        users: Users = TypeAdapter(Users).validate_json(path.read_bytes())
    except OSError as error:
        raise ConfigurationError(f"the users' file {path} can not be read: {error.strerror or error}") from error
    except ValidationError as error:
        first = error.errors(include_input=False)[0]
        where = ".".join(str(part) for part in first["loc"]) or "the whole"
        raise ConfigurationError(f"the users' file {path} is not valid: {where}: {first['msg']}") from error
    if not users:
        raise ConfigurationError(f"the users' file {path} names nobody")
    return users


def router_settings(certificate: Path, key: Path, dictionary: Path, users: Users) -> dict[str, object]:
    """Zenoh's settings for the router; `dictionary` is where the names and passwords are written for it."""
    for file in (certificate, key):
        if not file.is_file():
            raise ConfigurationError(f"there is no file {file}")
    dictionary.touch(mode=0o600)
    dictionary.write_text("".join(f"{name}:{user.password}\n" for name, user in users.items()), encoding="ascii")
    return {
        "transport/link/tls/listen_certificate": str(certificate),
        "transport/link/tls/listen_private_key": str(key),
        "transport/auth/usrpwd/dictionary_file": str(dictionary),
        "access_control": access_control(users),
    }


def access_control(users: Mapping[str, BusUser]) -> dict[str, object]:
    """What the router lets through: nothing that no rule allows."""
    rules: list[dict[str, object]] = [
        # What reaches a process is what it has subscribed to or asked for, and that is ruled where it comes in.
        _rule("hears", ALL_MESSAGES, ("egress",), [f"{ROOT}/**"]),
        _rule("listens", HEARING, ("ingress",), [f"{ROOT}/*/{key}" for key in ("hb", "event", "state/**", "tele/**")]),
        _rule("looks", HEARING, ("ingress",), [f"{ROOT}/*/{key}" for key in ("truth/**", "sim/**", "alive/**")]),
        _rule("asks", ("query", "reply"), ("ingress",), [f"{ROOT}/*/cmd/**", f"{ROOT}/*/*/part"]),
        _rule("steers", ("put",), ("ingress",), [f"{ROOT}/*/teleop"]),
    ]
    policies: list[dict[str, object]] = []
    for name, user in users.items():
        if user.role is BusRole.ROBOT:
            own = [f"{ROOT}/{robot}/**" for robot in user.robots]
            rules.append(_rule(f"is {name}", ALL_MESSAGES, ("ingress",), own))
            allowed = ["hears", f"is {name}"]
        else:
            allowed = ["hears", "listens", "looks", *(("asks", "steers") if user.role is BusRole.CONSOLE else ())]
        policies.append({"rules": allowed, "subjects": [name]})
    return {
        "enabled": True,
        "default_permission": "deny",
        "rules": rules,
        "subjects": [{"id": name, "usernames": [name]} for name in users],
        "policies": policies,
    }


def own_settings(environment: Mapping[str, str] = os.environ) -> dict[str, object]:
    """Zenoh's settings for a process that has been given a name on a guarded bus; none for one that has not.

    Such a process speaks through the router alone: what went past it would go past its rules.
    """
    if USER not in environment:
        return {}
    if PASSWORD not in environment or CERTIFICATE not in environment:
        raise ConfigurationError(f"{USER} is set, so {PASSWORD} and {CERTIFICATE} must be too")
    if not Path(environment[CERTIFICATE]).is_file():
        raise ConfigurationError(f"{CERTIFICATE} names {environment[CERTIFICATE]}, which is no file")
    return {
        "mode": "client",
        "listen/endpoints": [],
        "connect/timeout_ms": round(1000 * ENTERING),
        "connect/exit_on_failure": True,
        "transport/link/tls/root_ca_certificate": environment[CERTIFICATE],
        "transport/auth/usrpwd/user": environment[USER],
        "transport/auth/usrpwd/password": environment[PASSWORD],
    }


def _rule(name: str, messages: tuple[str, ...], flows: tuple[str, ...], keys: list[str]) -> dict[str, object]:
    return {"id": name, "messages": messages, "flows": flows, "permission": "allow", "key_exprs": keys}
