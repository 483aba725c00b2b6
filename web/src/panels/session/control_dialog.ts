import { make } from "../../dom/elements";
import { switchRow } from "../../dom/rows";
import type { Participant } from "../../gen/phrenic/v1/control_pb";
import { controlWords, everybodys, refusalWords, type Roles, type Standing } from "../../session/participation";

/** Says in the header who controls the session; opens the dialog about it. */
export function controlBadge(standing: Standing, open: () => void): HTMLButtonElement {
  const words = make("span");
  const badge = make("button", { type: "button", id: "control-badge", className: "pill", onclick: open }, words);
  standing.roles.subscribe((roles) => {
    const asking = roles.mayHand ? (roles.control?.participants ?? []).filter(({ asks }) => asks) : [];
    words.textContent = asking.length > 0 ? `${controlWords(roles)} · ${asking[0].name} asks` : controlWords(roles);
    badge.dataset.asked = String(asking.length > 0);
    badge.title = "Who may change this session: ask for control, hand it over, follow the camera";
  });
  return badge;
}

/** Groups controls that change the session: disabled, with the reason, while somebody else controls it. */
export function controlled(standing: Standing, ...children: (Node | string)[]): HTMLFieldSetElement {
  const group = make("fieldset", { className: "controlled" }, ...children);
  standing.roles.subscribe((roles) => {
    group.disabled = !roles.mayChange;
    group.title = refusalWords(roles);
  });
  return group;
}

/** A dialog with one's name, who is there, and what one's role allows. */
export class ControlDialog {
  readonly element = make("dialog", { className: "chooser", id: "control", ariaLabel: "Who controls" });
  private readonly state = make("p", { id: "control-state" });
  private readonly name = make("input", { type: "text", id: "control-name", maxLength: 40, placeholder: "Your name" });
  private readonly acts = make("div", { className: "acts" });
  private readonly people = make("ul", { id: "control-people" });
  private readonly fault = make("p", { className: "fault", id: "control-fault" });

  constructor(
    private readonly standing: Standing,
    followed: () => void,
  ) {
    const close = make("button", { type: "button", onclick: () => this.element.close() }, "Close");
    const { row: follow, input } = switchRow(
      "Follow the camera of who controls",
      "The picture turns with theirs",
      (on) => {
        standing.identity.follows = on;
        followed();
      },
    );
    input.id = "control-follow";
    input.checked = standing.identity.follows;
    this.name.value = standing.identity.name;
    this.fault.setAttribute("role", "alert");
    this.element.append(
      make("header", {}, make("h2", {}, "Who controls"), close),
      this.state,
      this.nameRow(),
      this.acts,
      this.fault,
      this.people,
      follow,
    );
    standing.roles.subscribe((roles) => this.tell(roles));
    standing.fault.subscribe((words) => (this.fault.textContent = words));
  }

  show(): void {
    if (!this.element.open) this.element.showModal();
  }

  private nameRow(): HTMLElement {
    const enter = make("button", { type: "submit", id: "control-enter" }, "Enter");
    const form = make("form", { className: "link-row" }, make("label", { htmlFor: this.name.id }, "Your name"));
    form.append(this.name, enter);
    form.onsubmit = (event) => {
      event.preventDefault();
      void this.standing.enter(this.name.value.trim());
    };
    return form;
  }

  private tell(roles: Roles): void {
    this.state.textContent = `${controlWords(roles)}.${roles.me === "" ? " Enter with your name to take part." : ""}`;
    this.acts.replaceChildren(...this.actsOf(roles));
    this.people.replaceChildren(...(roles.control?.participants ?? []).map((person) => this.personRow(person, roles)));
  }

  private actsOf(roles: Roles): HTMLElement[] {
    const { standing } = this;
    const act = (id: string, words: string, onclick: () => unknown) =>
      make("button", { type: "button", id: `control-${id}`, onclick: () => void onclick() }, words);
    const acts: HTMLElement[] = [];
    if (roles.me === "") return acts;
    if (!roles.alone && !roles.asks) acts.push(act("take", takeWords(roles), () => standing.take()));
    if (roles.asks) acts.push(act("withdraw", "Ask no more", () => standing.release()));
    if (roles.alone && !roles.owner) acts.push(act("release", "Give control back", () => standing.release()));
    if (roles.owner && (roles.control?.controller !== "" || !everybodys(roles)))
      acts.push(act("lend", "Let everybody control", () => standing.lend()));
    return acts;
  }

  private personRow({ name, owner, asks }: Participant, roles: Roles): HTMLElement {
    const parts = [name === roles.me && "you", owner && "owner", asks && "asks for control"].filter(Boolean);
    if (name === roles.control?.controller) parts.push("controls");
    const row = make("li", {}, make("div", {}, make("b", {}, name), make("span", {}, parts.join(", "))));
    row.dataset.person = name;
    if (roles.mayHand && name !== roles.control?.controller && !(owner && name === roles.me)) {
      const hand = make("button", { type: "button", ariaLabel: `Hand control to ${name}` }, "Hand over");
      hand.onclick = () => void this.standing.hand(name);
      row.append(hand);
    }
    return row;
  }
}

function takeWords(roles: Roles): string {
  if (roles.owner) return roles.control?.controller ? "Take control back" : "Only I control";
  return roles.control?.controller ? "Ask for control" : "Take control";
}
