import type { ConnectionState } from "../../connection/session_connection";
import { make } from "../../dom/elements";
import type { Session } from "../../gen/phrenic/v1/session_pb";
import { formatNumber } from "../../parameters/numbers";
import type { SessionController } from "../../session/session_controller";
import type { Signal } from "../../state/signal";
import { decimal, t } from "../../language/translate";

/** Banners for a diverged session, a lost connection, a failed save and a refused call, with their remedies. */
export function banners(
  controller: SessionController,
  link: Signal<ConnectionState>,
  chooseSession: () => void,
): HTMLElement[] {
  const diverged = banner("alert", "diverged");
  let told: bigint | undefined;
  controller.session.subscribe((session) => {
    // Screen readers read an alert whenever it changes, so it changes once per divergence.
    const tick = session?.divergence?.tick;
    if (tick === told) return;
    told = tick;
    diverged.hidden = tick === undefined;
    if (session !== undefined) diverged.replaceChildren(...divergenceMessage(session, controller));
  });
  const lost = banner("status", "lost");
  link.subscribe((value) => {
    lost.hidden = value.kind !== "lost";
    if (value.kind === "lost") lost.replaceChildren(...lossMessage(value.reason, value.missing, chooseSession));
  });
  const unsaved = banner("status", "unsaved");
  controller.session.subscribe((session) => {
    const why = session?.notSaved ?? "";
    if (unsaved.textContent === unsavedText(why)) return;
    unsaved.hidden = why === "";
    unsaved.replaceChildren(make("p", {}, unsavedText(why)));
  });
  const warned = banner("status", "warned");
  controller.session.subscribe((session) => {
    const text = (session?.warnings ?? []).map(sentence).join(" ");
    if (warned.textContent === text) return;
    warned.hidden = text === "";
    warned.replaceChildren(make("p", {}, text));
  });
  const notice = banner("status", "notice");
  controller.notice.subscribe((text) => {
    notice.hidden = text === "";
    const dismiss = make("button", { type: "button", onclick: () => controller.notice.set("") }, t("Dismiss"));
    notice.replaceChildren(make("p", {}, sentence(text)), dismiss);
  });
  return [diverged, lost, unsaved, warned, notice];
}

function unsavedText(why: string): string {
  return why === ""
    ? ""
    : t("The last changes are not saved: {0}. The session continues and is saved when the problem is solved.", why);
}

function banner(role: string, name: string): HTMLElement {
  const element = make("div", { className: `banner ${name}`, id: `banner-${name}`, hidden: true });
  element.setAttribute("role", role);
  return element;
}

function divergenceMessage({ divergence, largestStableStep }: Session, controller: SessionController): HTMLElement[] {
  if (divergence === undefined) return [];
  const { time, body, vertex, force, remedy } = divergence;
  const when = decimal(formatNumber(time));
  const where = t("The simulation diverged at {0} s, at vertex {1} of {2} ({3}).", when, String(vertex), body, force);
  const restart = make("button", { type: "button", className: "primary" }, t("Restart with a stable time step"));
  restart.onclick = () => void restartStable(controller, largestStableStep);
  const halve = make("button", { type: "button", title: t(halvingHelp) }, t("Restart with adaptive steps"));
  halve.onclick = () => void restartHalving(controller);
  return [make("p", {}, make("b", {}, where), " ", sentence(remedy)), restart, halve];
}

/** Error tolerance per step for adaptive step halving [m]. */
const tolerance = 1e-5;
const halvingHelp = "Sets the step tolerance: steps with an error above 0.01 mm are halved, which takes longer";

async function restartHalving(controller: SessionController): Promise<void> {
  await controller.reset();
  await controller.apply({ stepTolerance: tolerance });
  await controller.play(controller.session.value?.speed || "fastest");
}

/** Formats a server message as a sentence; names with an underscore keep their case. */
function sentence(words: string): string {
  const named = /^\w*_/.test(words);
  return (named ? words : words.slice(0, 1).toUpperCase() + words.slice(1)).replace(/([^.!?])$/, "$1.");
}

/** Fraction of the largest stable step; the server's own default. */
const stablePart = 0.9;

async function restartStable(controller: SessionController, largest: number): Promise<void> {
  await controller.reset();
  const now = controller.session.value?.parameters?.timeStep ?? 0;
  if (largest > 0 && now > stablePart * largest) await controller.apply({ timeStep: stablePart * largest });
  await controller.play(controller.session.value?.speed || "fastest");
}

function lossMessage(reason: string, missing: boolean, chooseSession: () => void): HTMLElement[] {
  const words = missing
    ? sentence(reason)
    : t("The connection is lost: {0} Reconnecting automatically.", sentence(reason));
  const choose = make("button", { type: "button", onclick: chooseSession }, t("Choose a session"));
  return [make("p", {}, words), ...(missing ? [choose] : [])];
}
