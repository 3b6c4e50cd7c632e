/** Battery and power at a glance. */
import { fixed, percent } from "../components/format";
import { Reading } from "../components/Reading";
import { useLatest } from "../console/useLatest";

const LOW = 0.2;

export function PowerReadings() {
  const power = useLatest("tele/power");
  const fraction = power?.battery_fraction ?? null;
  return (
    <div className="power" data-low={fraction !== null && fraction < LOW}>
      <Reading label="Battery" source="tele/power" value={fixed(power?.battery_voltage, 1)} unit="V">
        <span className="unit">
          {" "}
          {percent(fraction)} %{fraction !== null && fraction < LOW ? ", low" : ""}
        </span>
      </Reading>
      <Reading label="Power" source="tele/power" value={fixed(power?.supply_power, 0)} unit="W" />
    </div>
  );
}
