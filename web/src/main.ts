import { createGrpcWebTransport } from "@connectrpc/connect-web";
import { createApi, errorText } from "./api";
import { App } from "./app";
import { chooseSession } from "./choose_session";
import { systemClock } from "./clock";
import { Chooser } from "./panels/chooser";
import { make, place } from "./panels/dom";

// What is sent while the page goes outlives it: a vertex that is let go of.
let leaving = false;
window.addEventListener("pagehide", () => (leaving = true), { capture: true });
window.addEventListener("pageshow", () => (leaving = false));
const carry: typeof fetch = (input, init) => fetch(input, { ...init, keepalive: leaving });

// The page and the services come from one address.
const api = createApi(createGrpcWebTransport({ baseUrl: location.origin, fetch: carry }));

function address(sessionId: string): string {
  return `?${new URLSearchParams({ session: sessionId })}`;
}

const chooser = new Chooser(api, (sessionId) => location.assign(address(sessionId)));
document.body.append(chooser.element);

const loading = place("loading");
const start = make("button", { type: "button", onclick: () => void chooser.show() }, "Start one");

function say(error?: unknown): void {
  if (error === undefined) loading.replaceChildren("The server has no session yet. ", start);
  else loading.replaceChildren(`No answer from the server (${errorText(error)}). Trying again…`);
}

const sessionId = await chooseSession(new URL(location.href), api, systemClock, say);
loading.replaceChildren("Loading the scene…");
history.replaceState(null, "", address(sessionId));
try {
  new App(api, sessionId, chooser, systemClock).start();
} catch (error) {
  loading.replaceChildren(
    "This browser cannot draw: Phrenic needs WebGL 2. Switch hardware acceleration on, or update it.",
  );
  throw error;
}
