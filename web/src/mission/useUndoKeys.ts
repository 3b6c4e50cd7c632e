/** Ctrl+Z and Ctrl+Shift+Z (or Ctrl+Y) for the mission, except where they edit text. */
import { useEffect } from "react";
import { isTextField } from "../stop/keys";
import { useDraft } from "./draftStore";

export function useUndoKeys(): void {
  useEffect(() => {
    const press = (event: KeyboardEvent) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey || isTextField(event.target)) return;
      const key = event.key.toLowerCase();
      if (key !== "z" && key !== "y") return;
      event.preventDefault();
      useDraft.getState().dispatch({ type: key === "y" || event.shiftKey ? "redo" : "undo" });
    };
    window.addEventListener("keydown", press);
    return () => window.removeEventListener("keydown", press);
  }, []);
}
