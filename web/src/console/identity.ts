/** Who this page is: an id for each load, and the operator's name kept for the tab's next load. */

const OPERATOR = "weaver.operator";

export function newPageId(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
}

export function rememberedOperator(): string | null {
  return sessionStorage.getItem(OPERATOR) ?? localStorage.getItem(OPERATOR);
}

export function rememberOperator(name: string): void {
  sessionStorage.setItem(OPERATOR, name);
  if (localStorage.getItem(OPERATOR) === null) localStorage.setItem(OPERATOR, name);
}

export function socketAddress(page: string): string {
  const address = new URL("ws", document.baseURI);
  address.protocol = location.protocol === "https:" ? "wss:" : "ws:";
  address.searchParams.set("page", page);
  const operator = rememberedOperator();
  if (operator !== null) address.searchParams.set("operator", operator);
  return address.toString();
}
