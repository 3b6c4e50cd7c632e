"""`weaver console user`: who may use the console when it is open to other computers."""

from __future__ import annotations

import argparse
import getpass
import json
import sys
from collections.abc import Callable
from contextlib import closing
from datetime import datetime
from pathlib import Path

from weaver_console.access import Role, UserStore
from weaver_console.database import Database, data_folder
from weaver_shared.errors import InputError


def main(arguments: list[str]) -> int:
    options = _parser().parse_args(arguments)
    with closing(Database(options.data / "console.sqlite3")) as database:
        done: Callable[[UserStore, argparse.Namespace], None] = options.done
        done(UserStore(database), options)
    return 0


def _add(users: UserStore, options: argparse.Namespace) -> None:
    role = Role.named(options.role)
    users.add(options.name, role, _password(options.password_file))
    print(f"{options.name} may use the console as {role}")


def _list(users: UserStore, options: argparse.Namespace) -> None:
    every = users.all()
    if options.json:
        print(json.dumps({"users": [user.to_page() for user in every]}))
        return
    for user in every:
        added = datetime.fromtimestamp(user.added).strftime("%Y-%m-%d")
        print(f"{user.name:40} {user.role:9} since {added}  {user.tokens} tokens")


def _remove(users: UserStore, options: argparse.Namespace) -> None:
    users.remove(options.name)
    print(f"{options.name} may use the console no more")


def _change_password(users: UserStore, options: argparse.Namespace) -> None:
    users.set_password(options.name, _password(options.password_file))
    print(f"{options.name} has a new password and has to log in again; old tokens are void")


def _change_role(users: UserStore, options: argparse.Namespace) -> None:
    role = Role.named(options.role)
    users.set_role(options.name, role)
    print(f"{options.name} is {role} now")


def _token(users: UserStore, options: argparse.Namespace) -> None:
    if options.remove:
        print(f"{users.remove_tokens(options.name)} tokens of {options.name} are void")
    else:
        print(users.add_token(options.name))


def _password(path: Path | None) -> str:
    """From the file's first line, else asked for twice. Raises InputError when it can not be had."""
    if path is not None:
        try:
            return path.read_text(encoding="utf-8").partition("\n")[0].strip()
        except (OSError, UnicodeError) as error:
            raise InputError(f"the password file {path} can not be read: {error}") from error
    if not sys.stdin.isatty():
        raise InputError("there is nobody to ask for the password; give --password-file")
    password = getpass.getpass("Password: ")
    if getpass.getpass("Again: ") != password:
        raise InputError("the two passwords differ")
    return password


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="weaver console user", description=__doc__)
    data = "folder of the console's database (default %(default)s)"
    parser.add_argument("--data", type=Path, default=data_folder(), help=data)
    actions = parser.add_subparsers(required=True, metavar="ACTION")

    def action(name: str, done: object, told: str, *, named: bool = True) -> argparse.ArgumentParser:
        made = actions.add_parser(name, help=told, description=told)
        made.set_defaults(done=done)
        if named:
            made.add_argument("name", help="the user's name, which operators and the event log see")
        return made

    roles = ", ".join(Role)
    file = "file whose first line is the password; asked for otherwise"
    add = action("add", _add, "add a user")
    add.add_argument("--role", default=Role.OPERATOR.value, help=f"{roles} (%(default)s)")
    add.add_argument("--password-file", type=Path, help=file)
    listing = action("list", _list, "list the users", named=False)
    listing.add_argument("--json", action="store_true", help="print one JSON object")
    action("remove", _remove, "remove a user; their sessions and tokens end")
    change = action("password", _change_password, "give a user another password")
    change.add_argument("--password-file", type=Path, help=file)
    role = action("role", _change_role, "give a user another role")
    role.add_argument("role", help=roles)
    token = action("token", _token, "make a token by which a program of the user's comes in, and print it")
    token.add_argument("--remove", action="store_true", help="make all tokens of the user void instead")
    return parser
