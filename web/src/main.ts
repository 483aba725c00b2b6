import { createGrpcWebTransport } from "@connectrpc/connect-web";
import { App } from "./app/app";
import { bodyOpener } from "./app/body_opener";
import { patientOpener } from "./app/patient_opener";
import { createApi, errorText } from "./connection/api";
import { Credentials, credentialsInterceptor, storeJoinLink } from "./connection/credentials";
import { Identity, identityInterceptor } from "./connection/identity";
import { userStorage } from "./connection/launch";
import { routingInterceptor } from "./connection/routing";
import { elementById, make } from "./dom/elements";
import { ownStorage, tabStorage } from "./dom/storage";
import { SessionChooser } from "./panels/session/session_chooser";
import { signIn } from "./panels/session/sign_in";
import { chooseSession } from "./session/choose_session";
import { languageOf, openLanguage } from "./language/language";
import { fetchJson, lessonPlaceOf } from "./session/lessons";
import { pageViewOf, withPageView } from "./session/page_view";
import { recipeOf, rerun } from "./session/permalink";
import { systemClock } from "./timing/clock";
import { t } from "./language/translate";

// Requests while the page is closed must outlive it, such as the release of a pulled vertex.
let leaving = false;
window.addEventListener("pagehide", () => (leaving = true), { capture: true });
window.addEventListener("pageshow", () => (leaving = false));
const fetchKeepingAlive: typeof fetch = (input, init) => fetch(input, { ...init, keepalive: leaving });

// The page and the services have the same origin.
const here = new URL(location.href);
const storage = userStorage(here, ownStorage, tabStorage);
const identity = new Identity(storage);
const credentials = new Credentials(storage);
const interceptors = [identityInterceptor(identity), credentialsInterceptor(credentials), routingInterceptor()];
const api = createApi(createGrpcWebTransport({ baseUrl: location.origin, fetch: fetchKeepingAlive, interceptors }));

function address(sessionId: string): string {
  return `?${new URLSearchParams({ session: sessionId })}`;
}

await openLanguage(languageOf(here, ownStorage, navigator.languages), fetchJson);

const openSession = (sessionId: string) => location.assign(address(sessionId));
const importPatient = patientOpener(api, openSession);
const chooseBody = bodyOpener(api, openSession);
const chooser = new SessionChooser(
  api,
  openSession,
  () => void chooseBody(),
  () => void importPatient(),
);
document.body.append(chooser.element);

const loading = elementById("loading");
const start = make("button", { type: "button", onclick: () => void chooser.show() }, t("Start a session"));

function showWaiting(error?: unknown): void {
  if (error === undefined) loading.replaceChildren(t("The server has no session yet. "), start);
  else loading.replaceChildren(t("No answer from the server ({0}). Trying again…", errorText(error)));
}

storeJoinLink(here, credentials);

/** Returns the session of the address, or runs the simulation that the address describes. */
async function findSession(): Promise<string> {
  const recipe = recipeOf(here);
  if (recipe === undefined) return chooseSession(here, api, systemClock, showWaiting);
  return rerun(api, recipe, (part) => {
    loading.replaceChildren(t("Running {0} again: {1} %", recipe.scene, Math.round(100 * part)));
  });
}

await signIn(api, credentials, loading);
const sessionId = await findSession().catch((error: unknown) => {
  loading.replaceChildren(t("The simulation of this link cannot be repeated: {0}. ", errorText(error)), start);
  throw error;
});
const secondSessionId = here.searchParams.get("beside") ?? undefined;
// An embedded page shows only the scene and the playback controls.
const embedded = here.searchParams.has("embed");
document.body.classList.toggle("embedded", embedded);
loading.replaceChildren(t("Loading the scene…"));
const view = embedded ? "expert" : pageViewOf(here, ownStorage);
const shown = secondSessionId === undefined && !embedded ? address(sessionId) : here.search;
const lesson = lessonPlaceOf(here);
history.replaceState(null, "", withPageView(shown, view));
elementById("open-full").setAttribute("href", address(sessionId));
try {
  const viewNow = () => (document.body.classList.contains("student") ? "student" : "expert");
  // A launch goes on in the next page, also where the browser keeps nothing.
  const launch = identity.launched ? here.hash : "";
  const open = (query: string) => location.assign(withPageView(query, viewNow()) + launch);
  const subject = { sessionId, secondSessionId, view, lesson, address: here, open, importPatient };
  new App(api, subject, chooser, identity, systemClock).start();
} catch (error) {
  loading.replaceChildren(
    t("This browser cannot draw the scene: Phrenic needs WebGL 2. Enable hardware acceleration or update the browser."),
  );
  throw error;
}
