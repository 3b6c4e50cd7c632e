/** 3-D view, map and camera: one large, the others small. Changing places never reloads the 3-D view. */
import { Button } from "@mantine/core";
import { type ReactNode, useMemo } from "react";
import { type MainView, usePreferences } from "../console/preferences";
import { useConsole } from "../console/store";
import { MeasureTool } from "../measure/MeasureTool";
import { LayerLegend } from "../map/LayerLegend";
import { MapCanvas } from "../map/MapCanvas";
import { CameraView } from "./CameraView";
import { SceneFrame } from "./SceneFrame";
import { SavePicture } from "./SavePicture";
import { ViewOptions } from "./ViewOptions";
import { probeWebGl } from "./webgl";

const TITLES: Record<MainView, string> = { scene: "3-D view", map: "Map", camera: "Camera" };

export function Views() {
  const webGl = useMemo(probeWebGl, []);
  const without3d = useConsole((state) => state.hello !== null && state.hello.scene === null);
  const preferred = usePreferences((state) => state.mainView);
  const withScene = webGl.available && !without3d;
  const main = preferred === "scene" && !withScene ? "map" : preferred;
  return (
    <div className="views" data-main={main} data-scene={withScene}>
      <div className="views-bar">
        <LayerLegend />
        <MeasureTool />
        <SavePicture main={main} />
        <ViewOptions />
        {!withScene && (
          <span className="hint">
            {webGl.available
              ? "The console runs without its 3-D view."
              : "This browser has no WebGL 2, so there is no 3-D view."}
          </span>
        )}
      </div>
      {withScene && (
        <View name="scene" main={main}>
          <SceneFrame coarse={webGl.software} />
        </View>
      )}
      <View name="map" main={main}>
        <MapCanvas />
      </View>
      <View name="camera" main={main}>
        <CameraView />
      </View>
    </div>
  );
}

function View({ name, main, children }: { name: MainView; main: MainView; children: ReactNode }) {
  return (
    <section className={`view view-${name}`} aria-label={`${TITLES[name]} area`} data-large={name === main}>
      {children}
      {name !== main && (
        <Button
          className="enlarge"
          size="compact-xs"
          variant="default"
          aria-label={`Enlarge ${TITLES[name]}`}
          onClick={() => usePreferences.setState({ mainView: name })}
        >
          Enlarge
        </Button>
      )}
    </section>
  );
}
