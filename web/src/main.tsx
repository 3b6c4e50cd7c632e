/** Starts the page. */
import { MantineProvider } from "@mantine/core";
import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { App } from "./App";
import { startSession } from "./console/session";
import "./style/mantine.css";
import "./style/base.css";
import "./style/topbar.css";
import "./style/views.css";
import "./style/panels.css";
import "./style/replay.css";
import "./style/calibration.css";
import { colourVariables, theme } from "./theme";

const root = document.getElementById("root");
if (root === null) throw new Error("index.html has no element #root");
startSession(); // the console answers while the page is drawn for the first time
createRoot(root).render(
  <StrictMode>
    <MantineProvider theme={theme} cssVariablesResolver={colourVariables} defaultColorScheme="auto">
      <App />
    </MantineProvider>
  </StrictMode>,
);
