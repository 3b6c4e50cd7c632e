/** Keys pressed while the 3-D view has the focus: its frame keeps them from the page and posts them instead. */

export interface SceneKey {
  source: "weaver-scene";
  type: "key";
  event: "keydown" | "keyup";
  key: string;
  code: string;
  repeat: boolean;
  ctrlKey: boolean;
  shiftKey: boolean;
  altKey: boolean;
  metaKey: boolean;
}

/** Calls `listener` for each key from a frame of our own origin; the returned function ends it. */
export function onSceneKey(listener: (key: SceneKey) => void): () => void {
  const receive = (event: MessageEvent<unknown>) => {
    if (event.origin === location.origin && isSceneKey(event.data)) listener(event.data);
  };
  window.addEventListener("message", receive);
  return () => window.removeEventListener("message", receive);
}

function isSceneKey(data: unknown): data is SceneKey {
  if (typeof data !== "object" || data === null) return false;
  const { source, type } = data as Partial<SceneKey>;
  return source === "weaver-scene" && type === "key";
}
