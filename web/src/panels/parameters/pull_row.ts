import { make } from "../../dom/elements";
import type { SessionController } from "../../session/session_controller";

/** How many pulls act on the session, whoever's they are, and a button that lets go of them; hidden where there are none. */
export function pullRow(controller: SessionController): HTMLElement {
  const words = make("span");
  const letGo = make(
    "button",
    { type: "button", id: "let-go", onclick: () => void controller.releasePulls() },
    "Let go",
  );
  const row = make("div", { className: "pull-row", id: "pulls", hidden: true }, words, letGo);
  controller.session.subscribe((session) => {
    const pulls = session?.pulls ?? [];
    row.hidden = pulls.length === 0;
    words.textContent = pulls.length === 1 ? "One vertex is pulled" : `${pulls.length} vertices are pulled`;
  });
  return row;
}
