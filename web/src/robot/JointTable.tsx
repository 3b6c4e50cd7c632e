/** Every joint with its angle, torque, temperature and error. Folded away: thirty rows are for a closer look. */
import { useState } from "react";
import { UNKNOWN, degrees, fixed } from "../components/format";
import { selectedRobot } from "../console/control";
import { type Level, spokenAge } from "../console/freshness";
import { useConsole } from "../console/store";
import { useFreshness, useLatest } from "../console/useLatest";
import type { Maybe, ServoStates } from "../protocol/messages";
import { HOT, WARM, heatOf } from "./heat";

const MOTION = "tele/state";
const SERVOS = "tele/servos";
/** Closer to a limit than this a joint is marked, rad. */
const CLOSE = 0.05;

export function JointTable() {
  const [open, setOpen] = useState(false);
  return (
    <details className="joints" onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>Joints</summary>
      {open && <Rows />}
    </details>
  );
}

function Rows() {
  const robot = useConsole(selectedRobot);
  const state = useFresh(MOTION);
  const servos = useFresh(SERVOS);
  return (
    <>
      <table className="loops" aria-label="Joints">
        <thead>
          <tr>
            <th scope="col">Joint</th>
            <th scope="col">Angle, °</th>
            <th scope="col">Limits, °</th>
            <th scope="col">Torque, N m</th>
            <th scope="col">Temp., °C</th>
            <th scope="col">Error</th>
          </tr>
        </thead>
        <tbody>
          {(robot?.joint_names ?? []).map((name, index) => (
            <tr key={name}>
              <th scope="row">{name}</th>
              <Angle level={state.level} angle={state.value?.joint_position[index]} limits={robot?.joint_limits[index]} />
              <td data-freshness={state.level}>{fixed(state.value?.joint_torque[index], 1)}</td>
              <Temperature level={servos.level} servos={servos.value} index={index} />
              <Fault level={servos.level} servos={servos.value} index={index} />
            </tr>
          ))}
        </tbody>
      </table>
      <p className="hint">
        Warm from {WARM} °C: less torque; hot at {HOT} °C: it sits down. {servos.value && missing(servos.value)}{" "}
        {servos.level === "stale" && `Temperatures are ${spokenAge(servos.age)} old.`}
        {servos.level === "lost" && `Temperatures are lost since ${spokenAge(servos.age)}.`}
      </p>
    </>
  );
}

/** In words what this robot's servos do not tell. */
function missing({ temperature, faults }: ServoStates): string {
  const cool = temperature.every((degrees) => degrees === null);
  const what = [cool && "Temperatures", faults.length === 0 && (cool ? "errors" : "Errors")].filter(Boolean);
  return what.length === 0 ? "" : `${what.join(" and ")} are not measured on this robot.`;
}

/** A message's newest value, none once it is lost. */
function useFresh<K extends typeof MOTION | typeof SERVOS>(key: K) {
  const value = useLatest(key);
  const { level, age } = useFreshness(key);
  return { value: level === "lost" || level === "never" ? undefined : value, level, age };
}

interface AngleProps {
  level: Level;
  angle: Maybe | undefined;
  limits: [number, number] | undefined;
}

function Angle({ level, angle, limits }: AngleProps) {
  const [lower, upper] = limits ?? [NaN, NaN];
  const close = typeof angle === "number" && (angle < lower + CLOSE || angle > upper - CLOSE);
  return (
    <>
      <td data-freshness={level}>
        {degrees(angle)}
        {close && " at its limit"}
      </td>
      <td>
        {degrees(lower, 0)} to {degrees(upper, 0)}
      </td>
    </>
  );
}

interface ServoProps {
  level: Level;
  servos: ServoStates | undefined;
  index: number;
}

function Temperature({ level, servos, index }: ServoProps) {
  const temperature = servos?.temperature[index];
  const heat = heatOf(temperature);
  return (
    <td data-freshness={level} data-heat={heat ?? undefined}>
      {fixed(temperature, 0)}
      {heat !== null && ` ${heat}`}
    </td>
  );
}

function Fault({ level, servos, index }: ServoProps) {
  const fault = servos?.faults[index];
  return (
    <td data-freshness={level} data-fault={fault ? true : undefined}>
      {fault === undefined ? UNKNOWN : fault === "" ? "none" : `! ${fault}`}
    </td>
  );
}
