/** Optional parts of the views. */
import { Button, Menu } from "@mantine/core";
import { send } from "../console/outbox";
import { usePreferences } from "../console/preferences";

type Option = keyof ReturnType<typeof usePreferences.getState>["view"];

const OPTIONS: readonly (readonly [Option, string])[] = [
  ["follow", "Camera follows the robot"],
  ["trail", "Trail"],
  ["frusta", "Camera frusta"],
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
          <Menu.Item key={option} role="menuitemcheckbox" aria-checked={view[option]} onClick={() => toggle(option)}>
            <span aria-hidden>{view[option] ? "☑ " : "☐ "}</span>
            {label}
          </Menu.Item>
        ))}
      </Menu.Dropdown>
    </Menu>
  );
}
