/** Optional parts of the views. */
import { Button, Menu } from "@mantine/core";
import { send } from "../console/outbox";
import { usePreferences } from "../console/preferences";
import { TORQUE, TRANSPORT } from "../map/colourScale";
import { ColourKey } from "./ColourKey";

type Option = keyof ReturnType<typeof usePreferences.getState>["view"];

const OPTIONS: readonly (readonly [Option, string])[] = [
  ["follow", "Camera follows the robot"],
  ["trail", "Trail, coloured by cost of transport"],
  ["contours", "Contour lines every 5 cm"],
  ["torques", "Joint torques as colour"],
  ["frusta", "Camera frusta with pictures"],
  ["truth", "Ground truth (simulation)"],
];

export function ViewOptions() {
  const view = usePreferences((state) => state.view);
  const toggle = (option: Option) => {
    const changed = { ...view, [option]: !view[option] };
    usePreferences.setState({ view: changed });
    send({ type: "view", ...changed });
  };
  return (
    <Menu closeOnItemClick={false} position="bottom-end">
      <Menu.Target>
        <Button size="xs" variant="default">
          View options
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        {OPTIONS.map(([option, label]) => (
          <Menu.CheckboxItem key={option} checked={view[option]} onChange={() => toggle(option)}>
            {label}
          </Menu.CheckboxItem>
        ))}
        <ColourKey label="Trail, cost of transport" scale={TRANSPORT} ends={["2", "20"]} />
        <ColourKey label="Joint torque, % of stall" scale={TORQUE} ends={["0", "100"]} />
      </Menu.Dropdown>
    </Menu>
  );
}
