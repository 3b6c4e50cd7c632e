/** What this browser can draw in three dimensions. */

export interface WebGl {
  available: boolean;
  /** Drawn by the processor: the picture is made coarser, since it shares its time with the rest of the page. */
  software: boolean;
}

const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;

export function probeWebGl(): WebGl {
  const context = document.createElement("canvas").getContext("webgl2");
  if (context === null) return { available: false, software: false };
  const names = context.getExtension("WEBGL_debug_renderer_info");
  const renderer: unknown = context.getParameter(names?.UNMASKED_RENDERER_WEBGL ?? context.RENDERER);
  context.getExtension("WEBGL_lose_context")?.loseContext();
  return { available: true, software: typeof renderer === "string" && SOFTWARE.test(renderer) };
}
