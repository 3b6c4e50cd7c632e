/** Colours and shapes. Every pair of text and ground here reaches WCAG AA (4.5:1). */
import { type CSSVariablesResolver, type MantineColorsTuple, createTheme } from "@mantine/core";

const sea: MantineColorsTuple = [
  "#e6f4f7", "#cbe6ed", "#9dd0dc", "#6bb8ca", "#3f9fb5", "#1f8aa2", "#127690", "#0b6b80", "#075a70", "#054a5d",
];
const slate: MantineColorsTuple = [
  "#e8edf2", "#c7d0d9", "#a5b0bc", "#8391a0", "#4b5967", "#384552", "#29343f", "#1c252e", "#141b22", "#0d1218",
];

export const theme = createTheme({
  primaryColor: "sea",
  primaryShade: { light: 7, dark: 6 },
  autoContrast: true,
  luminanceThreshold: 0.3,
  colors: { sea, dark: slate },
  fontFamily: "-apple-system, 'Segoe UI', Roboto, 'Noto Sans', 'DejaVu Sans Condensed', system-ui, sans-serif",
  defaultRadius: "sm",
  cursorType: "pointer",
  respectReducedMotion: true,
});

export const colourVariables: CSSVariablesResolver = () => ({
  variables: {},
  light: {
    "--mantine-color-body": "#eef1f4",
    "--mantine-color-dimmed": "#4a5763",
    "--mantine-color-placeholder": "#5a6773",
    "--panel": "#ffffff",
    "--sunk": "#f2f5f7",
    "--line": "#ccd4dc",
    "--text": "#10202c",
    "--quiet": "#4a5763",
    "--good": "#11663a",
    "--good-ground": "#dff3e6",
    "--caution": "#7a4600",
    "--caution-ground": "#fff0d4",
    "--danger": "#a81420",
    "--danger-ground": "#fde4e4",
    "--active": "#075a70",
    "--active-ground": "#d9f0f5",
    "--sim": "#1c4f9c",
    "--emulated": "#6a2c91",
    "--real": "#a3350a",
    "--applied": "#0b6b80",
    "--desired": "#8a4b00",
  },
  dark: {
    "--mantine-color-body": "#0d1218",
    "--mantine-color-dimmed": "#a5b0bc",
    "--mantine-color-placeholder": "#8f9cab",
    "--panel": "#161e26",
    "--sunk": "#10171e",
    "--line": "#33404c",
    "--text": "#e8edf2",
    "--quiet": "#a5b0bc",
    "--good": "#7fe0a6",
    "--good-ground": "#12321f",
    "--caution": "#ffc874",
    "--caution-ground": "#3a2a0c",
    "--danger": "#ff9d9d",
    "--danger-ground": "#45161a",
    "--active": "#8bdcf0",
    "--active-ground": "#0e3340",
    "--sim": "#2a5fb0",
    "--emulated": "#7a3aa5",
    "--real": "#b0410f",
    "--applied": "#5fc4da",
    "--desired": "#ffb35c",
  },
});
