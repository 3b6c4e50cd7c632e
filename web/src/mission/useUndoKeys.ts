/** Ctrl+Z and Ctrl+Shift+Z (or Ctrl+Y) for mission and areas, except where they edit text. */
import { useEffect } from "react";
import { undoCorner, useAreas } from "../areas/areaStore";
import { isTextField } from "../stop/keys";
import { useDraft } from "./draftStore";

export function useUndoKeys(): void {
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey || isTextField(event.target)) return;
      const key = event.key.toLowerCase();
      if (key !== "z" && key !== "y") return;
      event.preventDefault();
      const redo = key === "y" || event.shiftKey;
      if (!redo && useAreas.getState().drawing !== null) undoCorner();
      else useDraft.getState().dispatch({ type: redo ? "redo" : "undo" });
    };
    window.addEventListener("keydown", press);
    return () => window.removeEventListener("keydown", press);
  }, []);
}
