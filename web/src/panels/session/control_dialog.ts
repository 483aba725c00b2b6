import { make } from "../../dom/elements";
import { icon } from "../../dom/icons";
import { switchRow } from "../../dom/rows";
import type { Participant } from "../../gen/phrenic/v1/control_pb";
import {
  controlLabel,
  isOpenToEveryone,
  type Participation,
  refusalReason,
  type Roles,
} from "../../session/participation";
import { t } from "../../language/translate";

/** A button in the header that shows who controls the session and opens the dialog. */
export function controlBadge(participation: Participation, open: () => void): HTMLButtonElement {
  const words = make("span");
  const badge = make(
    "button",
    { type: "button", id: "control-badge", className: "pill", onclick: open },
    icon("person"),
    words,
  );
  participation.roles.subscribe((roles) => {
    const asking = roles.mayHandOver ? (roles.control?.participants ?? []).filter(({ asks }) => asks) : [];
    words.textContent =
      asking.length > 0 ? t("{0} · {1} asks", controlLabel(roles), asking[0].name) : controlLabel(roles);
    badge.dataset.asked = String(asking.length > 0);
    badge.title = t("Who may change this session: ask for control, hand it over, follow the camera");
  });
  return badge;
}

/** Groups controls that change the session; they are disabled with a reason while another participant has control. */
export function controlledGroup(participation: Participation, ...children: (Node | string)[]): HTMLFieldSetElement {
  const group = make("fieldset", { className: "controlled" }, ...children);
  participation.roles.subscribe((roles) => {
    group.disabled = !roles.mayChange;
    group.title = refusalReason(roles);
  });
  return group;
}

/** A dialog with the user's name, the participants, and the actions that the user's role allows. */
export class ControlDialog {
  readonly element = make("dialog", { className: "chooser", id: "control", ariaLabel: t("Who controls") });
  private readonly state = make("p", { id: "control-state" });
  private readonly name = make("input", {
    type: "text",
    id: "control-name",
    maxLength: 40,
    placeholder: t("Your name"),
  });
  private readonly actions = make("div", { className: "acts" });
  private readonly people = make("ul", { id: "control-people" });
  private readonly errorMessage = make("p", { className: "fault", id: "control-fault" });

  constructor(
    private readonly participation: Participation,
    followed: () => void,
  ) {
    const close = make("button", { type: "button", onclick: () => this.element.close() }, t("Close"));
    const { row: follow, input } = switchRow(
      t("Follow the camera of the participant in control"),
      t("Your view moves with theirs"),
      (on) => {
        participation.identity.followsCamera = on;
        followed();
      },
    );
    input.id = "control-follow";
    input.checked = participation.identity.followsCamera;
    this.name.value = participation.identity.name;
    this.errorMessage.setAttribute("role", "alert");
    this.element.append(
      make("header", {}, make("h2", {}, t("Who controls")), close),
      this.state,
      this.nameRow(),
      this.actions,
      this.errorMessage,
      this.people,
      follow,
    );
    participation.roles.subscribe((roles) => this.update(roles));
    participation.errorMessage.subscribe((words) => (this.errorMessage.textContent = words));
  }

  /** Opens the dialog. */
  show(): void {
    if (!this.element.open) this.element.showModal();
  }

  private nameRow(): HTMLElement {
    const enter = make("button", { type: "submit", id: "control-enter" }, t("Join"));
    const form = make("form", { className: "link-row" }, make("label", { htmlFor: this.name.id }, t("Your name")));
    form.append(this.name, enter);
    form.onsubmit = (event) => {
      event.preventDefault();
      void this.participation.enter(this.name.value.trim());
    };
    return form;
  }

  private update(roles: Roles): void {
    this.state.textContent = `${controlLabel(roles)}.${roles.name === "" ? ` ${t("Join with your name to take part.")}` : ""}`;
    this.actions.replaceChildren(...this.actionsFor(roles));
    this.people.replaceChildren(...(roles.control?.participants ?? []).map((person) => this.personRow(person, roles)));
  }

  private actionsFor(roles: Roles): HTMLElement[] {
    const { participation } = this;
    const button = (id: string, words: string, onclick: () => unknown) =>
      make("button", { type: "button", id: `control-${id}`, onclick: () => void onclick() }, words);
    const acts: HTMLElement[] = [];
    if (roles.name === "") return acts;
    if (!roles.hasControl && !roles.hasRequested)
      acts.push(button("take", takeLabel(roles), () => participation.requestControl()));
    if (roles.hasRequested) acts.push(button("withdraw", t("Withdraw the request"), () => participation.release()));
    if (roles.hasControl && !roles.isOwner)
      acts.push(button("release", t("Give control back"), () => participation.release()));
    if (roles.isOwner && (roles.control?.controller !== "" || !isOpenToEveryone(roles)))
      acts.push(button("open", t("Let everyone control"), () => participation.openToEveryone()));
    return acts;
  }

  private personRow({ name, owner, asks }: Participant, roles: Roles): HTMLElement {
    const parts = [name === roles.name && t("you"), owner && t("owner"), asks && t("asks for control")].filter(Boolean);
    if (name === roles.control?.controller) parts.push(t("controls"));
    const row = make("li", {}, make("div", {}, make("b", {}, name), make("span", {}, parts.join(", "))));
    row.dataset.person = name;
    if (roles.mayHandOver && name !== roles.control?.controller && !(owner && name === roles.name)) {
      const hand = make("button", { type: "button", ariaLabel: t("Hand control to {0}", name) }, t("Hand over"));
      hand.onclick = () => void this.participation.handOver(name);
      row.append(hand);
    }
    return row;
  }
}

function takeLabel(roles: Roles): string {
  if (roles.isOwner) return roles.control?.controller ? t("Take control back") : t("Take exclusive control");
  return roles.control?.controller ? t("Ask for control") : t("Take control");
}
