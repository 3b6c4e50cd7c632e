"""OpenSHC's own files (YAML, or the same as JSON) into a Configuration and back; errors name the key."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import yaml
from pydantic import ValidationError

from robot_agent.locomotion.openshc.configuration import Adjustable, Configuration
from weaver_shared.errors import ConfigurationError

SECTIONS = ("parameters", "gait_parameters", "auto_pose_parameters")
PER_LEG = ("_joint_parameters", "_link_parameters", "_stance_position", "leg_DOF")
COLLECTED = ("legs", "gaits", "auto_poses")
"""Fields of Configuration that OpenSHC spreads over many keys or other sections."""


def read_configuration(paths: Iterable[Path]) -> Configuration:
    """One robot from one file, or from several that complete each other: robot, gait.yaml, auto_pose.yaml.

    Raises ConfigurationError that names the key, what was found and what is valid.
    """
    sections: dict[str, dict[str, Any]] = {section: {} for section in SECTIONS}
    for path in paths:
        for section, values in _sections(_document(path), path).items():
            sections[section].update(values)
    return configuration_of(sections)


def configuration_of(sections: Mapping[str, Mapping[str, Any]]) -> Configuration:
    """From OpenSHC's three parameter sections as read from its files."""
    parameters = dict(sections["parameters"])
    if not sections["gait_parameters"]:
        raise ConfigurationError("gait_parameters: nothing was found; give the robot's gait.yaml too")
    fields = {**parameters, "legs": _legs(parameters), "gaits": sections["gait_parameters"]}
    fields["auto_poses"] = {
        name: _complete_pose(pose) for name, pose in sections.get("auto_pose_parameters", {}).items()
    }
    known = set(Configuration.model_fields) - set(COLLECTED)
    for key in parameters:
        if key not in known and not key.endswith(PER_LEG):
            raise ConfigurationError(f"parameters.{key}: this is no parameter of OpenSHC 0.5.11")
    fields = {key: value for key, value in fields.items() if key in Configuration.model_fields}
    try:
        return Configuration.model_validate(fields)
    except ValidationError as error:
        raise ConfigurationError(_sentence(error, fields)) from error


def sections_of(configuration: Configuration) -> dict[str, Any]:
    """The nested form of OpenSHC's files: `{"syropod": {"parameters": ..., ...}}`."""
    plain = configuration.model_dump(mode="json")
    parameters = {key: value for key, value in plain.items() if key not in COLLECTED}
    parameters["leg_DOF"] = {leg.name: len(leg.joints) for leg in configuration.legs}
    for leg in plain["legs"]:
        name = leg["name"]
        for joint, values in zip(configuration.joint_id, leg["joints"], strict=False):
            packed = values.pop("packed")
            postures = {"packed": packed[0]} if len(packed) == 1 else {f"packed_{k}": q for k, q in enumerate(packed)}
            parameters[f"{name}_{joint}_joint_parameters"] = {**values, **postures}
        for link, values in zip(configuration.link_id, leg["links"], strict=False):
            parameters[f"{name}_{link}_link_parameters"] = values
        parameters[f"{name}_stance_position"] = leg["stance"]
    poses = {name: _without_empty(pose) for name, pose in plain["auto_poses"].items()}
    return {
        "syropod": {"parameters": parameters, "gait_parameters": plain["gaits"], "auto_pose_parameters": poses},
    }


def with_settings(configuration: Configuration, settings: Iterable[str]) -> Configuration:
    """`configuration` with `key=value` replaced; an adjustable parameter takes its value, a group KEY.PART=VALUE."""
    plain = configuration.model_dump()
    for setting in settings:
        path, found, text = setting.partition("=")
        if not found:
            raise ConfigurationError(f"--set {setting!r} is not valid; use KEY=VALUE")
        _assign(plain, path, _scalar(text))
    try:
        return Configuration.model_validate(plain)
    except ValidationError as error:
        raise ConfigurationError(f"--set: {_sentence(error, plain)}") from error


def _assign(plain: dict[str, Any], path: str, value: Any) -> None:
    place, *parts = path.split(".")
    field = Configuration.model_fields.get(place)
    if field is None or place in COLLECTED:
        names = ", ".join(sorted(set(Configuration.model_fields) - set(COLLECTED)))
        raise ConfigurationError(f"--set {place!r} is no parameter of OpenSHC; known are {names}")
    if field.annotation is Adjustable and not parts:
        parts = ["default"]
    target: dict[str, Any] = plain
    for part in parts:
        target = target[place]
        place = part
        if not isinstance(target, dict) or place not in target:
            raise ConfigurationError(f"--set {path!r} is unknown; {part!r} is no part of it")
    target[place] = value


def _scalar(text: str) -> Any:
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError:
        return text


def _document(path: Path) -> Any:
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"{path} can not be read: {getattr(error, 'strerror', None) or error}") from error
    try:
        return json.loads(text) if path.suffix == ".json" else yaml.safe_load(text)
    except (json.JSONDecodeError, yaml.YAMLError) as error:
        where = " ".join(str(error).split())
        raise ConfigurationError(
            f"{path} is not valid {'JSON' if path.suffix == '.json' else 'YAML'}: {where}"
        ) from error


def _sections(document: Any, path: Path) -> dict[str, dict[str, Any]]:
    """The sections of a file, whatever the robot's namespace above them is called."""
    inner = document
    if isinstance(document, dict) and not set(SECTIONS) & set(document) and len(document) == 1:
        (inner,) = document.values()
    found = {key: inner[key] for key in SECTIONS if key in inner} if isinstance(inner, dict) else {}
    if not found:
        raise ConfigurationError(f"{path} has none of OpenSHC's sections; valid are {', '.join(SECTIONS)}")
    for section, values in found.items():
        if not isinstance(values, dict):
            raise ConfigurationError(f"{path}: {section} is {values!r:.60}; valid is a table of parameters")
    return found


def _legs(parameters: Mapping[str, Any]) -> list[dict[str, Any]]:
    legs, joints, links = (_names(parameters, key) for key in ("leg_id", "joint_id", "link_id"))
    freedom = parameters.get("leg_DOF", {})
    result = []
    for leg in legs:
        count = freedom.get(leg, len(joints)) if isinstance(freedom, dict) else len(joints)
        if not isinstance(count, int) or not 1 <= count <= len(joints):
            raise ConfigurationError(f"parameters.leg_DOF.{leg} is {count!r}; valid is 1 to {len(joints)}")
        result.append(
            {
                "name": leg,
                "joints": [_joint(parameters, f"{leg}_{joint}_joint_parameters") for joint in joints[:count]],
                "links": [_table(parameters, f"{leg}_{link}_link_parameters") for link in links[: count + 1]],
                "stance": _table(parameters, f"{leg}_stance_position"),
            }
        )
    return result


def _names(parameters: Mapping[str, Any], key: str) -> list[str]:
    value = parameters.get(key)
    if not isinstance(value, list | tuple) or not all(isinstance(name, str) for name in value):
        found = "missing" if value is None else repr(value)[:60]
        raise ConfigurationError(f"parameters.{key} is {found}; valid is a list of names")
    return list(value)


def _table(parameters: Mapping[str, Any], key: str) -> dict[str, Any]:
    value = parameters.get(key)
    if not isinstance(value, dict):
        found = "missing" if value is None else repr(value)[:60]
        raise ConfigurationError(f"parameters.{key} is {found}; valid is a table of numbers")
    return value


def _joint(parameters: Mapping[str, Any], key: str) -> dict[str, Any]:
    """Packing postures are `packed`, or `packed_0`, `packed_1` and so on in the order they are taken."""
    values = dict(_table(parameters, key))
    steps = sorted((name for name in values if name.startswith("packed_")), key=lambda name: int(name[7:] or 0))
    packed = [values.pop("packed")] if "packed" in values else []
    packed += [values.pop(name) for name in steps]
    return {**values, "packed": packed} if packed else values


def _complete_pose(pose: Any) -> Any:
    """Newer keys that older files lack: gravity amplitudes and transition ratios are zero then."""
    if not isinstance(pose, dict):
        return pose
    cycles = pose.get("pose_phase_starts", ())
    return {"gravity_amplitudes": [0.0] * len(cycles), **pose}


def _without_empty(pose: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in pose.items() if key != "negation_transition_ratio" or value}


def _sentence(error: ValidationError, fields: Mapping[str, Any]) -> str:
    """Key as OpenSHC writes it, complaint and what was found, of the first error."""
    first = error.errors()[0]
    complaint = str(first["ctx"]["error"]) if first["type"] == "value_error" else first["msg"]
    return f"{_key_of(first['loc'], fields)}: {complaint} (found {first['input']!r:.80})"


def _key_of(place: tuple[int | str, ...], fields: Mapping[str, Any]) -> str:
    match place:
        case ("legs", int(leg), "joints", int(joint), *rest):
            name = f"{fields['leg_id'][leg]}_{fields['joint_id'][joint]}_joint_parameters"
        case ("legs", int(leg), "links", int(link), *rest):
            name = f"{fields['leg_id'][leg]}_{fields['link_id'][link]}_link_parameters"
        case ("legs", int(leg), "stance", *rest):
            name = f"{fields['leg_id'][leg]}_stance_position"
        case _:
            name, rest = "", list(place)
    return ".".join(str(part) for part in (name, *rest) if part != "") or "parameters"
