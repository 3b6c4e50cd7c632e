/** One or two legs lifted off the ground, their feet moved by hand. */
import { Button } from "@mantine/core";
import { fixed } from "../components/format";
import { command } from "../console/commands";
import { selectedRobot, useHindrance } from "../console/control";
import { useConsole } from "../console/store";
import { useLatest } from "../console/useLatest";
import type { MotionOrders } from "../protocol/messages";
import { AxisSlider } from "./AxisSlider";
import { TIP_AXES } from "./axes";

const NOT_LIFTED: readonly string[] = [];

export function LegHandling() {
  const names = useConsole(selectedRobot)?.leg_names ?? NOT_LIFTED;
  const orders = useLatest("state/motion");
  const margins = useLatest("tele/locomotion")?.lift_margins;
  const lifting = useHindrance("lift_leg");
  const held = orders?.held_legs ?? [];
  return (
    <div className="body-part" role="group" aria-label="Legs in hand">
      <div className="button-row">
        {names.map((name, leg) => {
          const isHeld = held.includes(name);
          const margin = margins?.[leg];
          return (
            <Button
              key={name}
              size="xs"
              variant={isHeld ? "filled" : "default"}
              disabled={!isHeld && lifting !== null}
              title={isHeld ? undefined : (lifting ?? `${fixed(1000 * (margin ?? NaN), 0)} mm of stability without it`)}
              onClick={() => void command(isHeld ? "lower_leg" : "lift_leg", { name })}
            >
              {isHeld ? `Lower ${name}` : `Lift ${name}`}
            </Button>
          );
        })}
      </div>
      {orders !== undefined && held.map((name, index) => <Tip key={name} leg={name} index={index} orders={orders} />)}
    </div>
  );
}

function Tip({ leg, index, orders }: { leg: string; index: number; orders: MotionOrders }) {
  const hindrance = useHindrance("move_tip");
  const largest = useConsole(selectedRobot)?.motion?.largest_tip ?? 0;
  return (
    <>
      {TIP_AXES.map((axis, k) => (
        <AxisSlider
          key={axis.name}
          axis={{ ...axis, label: `${axis.label}, ${leg}` }}
          value={orders.held_tips[index]?.[k] ?? null}
          largest={largest}
          disabled={hindrance !== null}
          reason={hindrance}
          onChange={(value) => void command("move_tip", { name: `${leg}.${axis.name}`, value })}
        />
      ))}
    </>
  );
}
