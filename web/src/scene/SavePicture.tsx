/** Saves what the large view shows as a picture. */
import { Button } from "@mantine/core";
import { useState } from "react";
import { notify } from "../console/notices";
import type { MainView } from "../console/preferences";
import { useConsole } from "../console/store";

export function SavePicture({ main }: { main: MainView }) {
  const [waiting, setWaiting] = useState(false);
  const save = async () => {
    setWaiting(true);
    try {
      const picture = await pictureOf(main);
      saveAs(picture, `weaver_${main}_${stamp(new Date())}.${picture.type === "image/jpeg" ? "jpg" : "png"}`);
    } catch (error) {
      notify("error", `No picture was saved: ${error instanceof Error ? error.message : String(error)}`);
    }
    setWaiting(false);
  };
  return (
    <Button size="xs" variant="default" loading={waiting} onClick={() => void save()}>
      Save picture
    </Button>
  );
}

async function pictureOf(main: MainView): Promise<Blob> {
  if (main === "map") {
    const canvas = document.querySelector<HTMLCanvasElement>(".map canvas");
    const blob = canvas && (await new Promise<Blob | null>((resolve) => canvas.toBlob(resolve)));
    if (!blob) throw new Error("the map gave none");
    return blob;
  }
  if (main === "camera") return cameraPicture();
  const response = await fetch(sceneAddress());
  if (!response.ok) throw new Error(((await response.json()) as { error?: string }).error ?? `${response.status}`);
  return response.blob();
}

function cameraPicture(): Blob {
  const picture = document.querySelector<HTMLImageElement>(".camera img");
  if (picture === null) throw new Error("there is no picture yet");
  const bytes = Uint8Array.from(atob(picture.src.slice(picture.src.indexOf(",") + 1)), (c) => c.charCodeAt(0));
  return new Blob([bytes], { type: "image/jpeg" });
}

/** The 3-D view draws in a frame that the page can not look into: the console asks it for the picture. */
function sceneAddress(): string {
  const scene = useConsole.getState().hello?.scene;
  const box = document.querySelector("iframe.scene")?.getBoundingClientRect();
  if (scene == null || box === undefined) throw new Error("there is no 3-D view");
  return `${scene}picture?width=${Math.max(Math.round(box.width), 64)}&height=${Math.max(Math.round(box.height), 64)}`;
}

function saveAs(picture: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(picture);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

function stamp(now: Date): string {
  return now.toISOString().slice(0, 19).replaceAll(":", "-").replace("T", "_");
}
