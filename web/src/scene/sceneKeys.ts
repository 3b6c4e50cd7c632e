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

/** Calls `listener` for each key from a frame of this page; the returned function ends it. */
export function onSceneKey(listener: (key: SceneKey) => void): () => void {
  const receive = (event: MessageEvent<unknown>) => {
    // The 3-D view is sandboxed and has no origin to go by: what counts is that it is a frame directly in this page.
    if (isOurs(event.source) && isSceneKey(event.data)) listener(event.data);
  };
  window.addEventListener("message", receive);
  return () => window.removeEventListener("message", receive);
}

function isOurs(source: MessageEventSource | null): boolean {
  return [...document.querySelectorAll("iframe")].some((frame) => frame.contentWindow === source);
}

function isSceneKey(data: unknown): data is SceneKey {
  if (typeof data !== "object" || data === null) return false;
  const { source, type } = data as Partial<SceneKey>;
  return source === "weaver-scene" && type === "key";
}
