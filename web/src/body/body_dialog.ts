import bodies from "../../../client/examples/bodies.txt?raw";
import { type Api, errorText } from "../connection/api";
import { make } from "../dom/elements";
import { t } from "../language/translate";
import { controlsOfGroup, groups, readBodies, type ReadyBody } from "./body_numbers";
import { bodyRow } from "./body_row";
import { BodySession } from "./body_session";

/** A dialog that makes the thorax of a person from height, sex, age and shape, and lets it breathe. */
export class BodyDialog {
  readonly element = make("dialog", { className: "chooser", id: "body", ariaLabel: t("A body by sex, age and size") });
  private readonly body: BodySession;
  private readonly words = make("p");
  private readonly fault = make("p", { className: "fault" });
  private readonly go = make("button", { type: "button", id: "body-start", className: "primary" }, t("Let it breathe"));

  constructor(
    api: Api,
    /** Opens a session in the page. */
    private readonly open: (sessionId: string) => void,
  ) {
    this.body = new BodySession(api);
    this.words.setAttribute("role", "status");
    this.fault.setAttribute("role", "alert");
    this.go.onclick = () => void this.start();
    const close = make("button", { type: "button", onclick: () => this.element.close() }, t("Close"));
    const reset = make(
      "button",
      { type: "button", id: "body-reset", onclick: () => this.body.take({}) },
      t("Reset all"),
    );
    this.element.append(
      make("header", {}, make("h2", {}, t("A body by sex, age and size")), close),
      make(
        "p",
        {},
        t("The thorax of a person. Sex and age determine what you do not set; lungs and tissues scale with the size."),
      ),
      this.readyBodies(),
      ...groups.map((group) => this.section(group)),
      make("footer", {}, make("div", { className: "acts" }, this.go, reset), this.words, this.fault),
    );
  }

  /** Opens the dialog. */
  show(): void {
    if (!this.element.isConnected) document.body.append(this.element);
    if (!this.element.open) this.element.showModal();
    this.words.textContent = this.fault.textContent = "";
  }

  private readyBodies(): HTMLElement {
    const list = make("div", { className: "ready-bodies", ariaLabel: t("Example bodies") });
    list.setAttribute("role", "group");
    list.append(...readBodies(bodies).map((ready) => this.readyButton(ready)));
    return list;
  }

  private readyButton({ title, numbers }: ReadyBody): HTMLButtonElement {
    const button = make("button", { type: "button", onclick: () => this.body.take(numbers) }, t(title));
    this.body.numbers.subscribe(() => (button.ariaPressed = String(this.body.has(numbers))));
    return button;
  }

  private section(group: (typeof groups)[number]): HTMLElement {
    const rows = controlsOfGroup(group).map((control) => bodyRow(control, this.body));
    return make("section", {}, make("h3", {}, t(group.title)), ...rows);
  }

  private async start(): Promise<void> {
    this.go.disabled = true;
    this.fault.textContent = "";
    this.words.textContent = t("Compiling the scene…");
    try {
      this.open(await this.body.start());
    } catch (error) {
      this.fault.textContent = errorText(error);
    }
    this.words.textContent = "";
    this.go.disabled = false;
  }
}
