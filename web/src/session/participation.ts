import { toJsonString } from "@bufbuild/protobuf";
import { type Api, errorText } from "../connection/api";
import type { Identity } from "../connection/identity";
import { type Control, ControlPolicy, ControlSchema } from "../gen/phrenic/v1/control_pb";
import { Signal } from "../state/signal";
import type { Clock } from "../timing/clock";
import type { SessionController } from "./session_controller";
import { t } from "../language/translate";

/** Renewal interval of the participation [ms]; the server removes participants after `timeToLive` [s]. */
const renewalInterval = 10_000;
const timeToLive = 30;

/** Who controls the session, and the role of this viewer. */
export interface Roles {
  control: Control | undefined;
  /** The name of this viewer among the participants; empty for a spectator. */
  name: string;
  isOwner: boolean;
  /** True if only this viewer may change the session. */
  hasControl: boolean;
  mayChange: boolean;
  /** True if this viewer may hand control to others. */
  mayHandOver: boolean;
  hasRequested: boolean;
}

/** Returns the role of the participant `ownName`; an empty or unknown name is a spectator. */
export function rolesOf(control: Control | undefined, ownName: string): Roles {
  const self = control?.participants.find(({ name }) => name === ownName && name !== "");
  const hasControl = self !== undefined && control?.controller === self.name;
  const isOwner = self?.owner ?? false;
  const mayChange = hasControl || (control?.controller ?? "") === "";
  return {
    control,
    name: self?.name ?? "",
    isOwner,
    hasControl,
    mayChange,
    mayHandOver: hasControl || isOwner,
    hasRequested: self?.asks ?? false,
  };
}

/** Returns "You control", "Anna controls" or "Everyone controls". */
export function controlLabel({ control, hasControl }: Roles): string {
  if (hasControl) return t("You control");
  return control?.controller ? t("{0} controls", control.controller) : t("Everyone controls");
}

/** Returns why this viewer's controls are disabled; empty if they are enabled. */
export function refusalReason({ control, mayChange }: Roles): string {
  return mayChange
    ? ""
    : t("{0} controls this session: ask for control, or fork it under “Share”.", control?.controller ?? "");
}

/**
 * This viewer's participation in a session: joins with the user's name, renews it, and requests and hands over control.
 */
export class Participation {
  readonly roles = new Signal<Roles>(rolesOf(undefined, ""));
  /** The last refusal of the server; empty after a successful call. */
  readonly errorMessage = new Signal("");
  private name = "";
  private lastState = "";

  constructor(
    private readonly api: Api,
    private readonly controller: SessionController,
    readonly identity: Identity,
    private readonly clock: Clock,
  ) {
    controller.session.subscribe((session) => this.update(session?.control));
  }

  /**
   * Session states arrive every second; roles are only set if something changed, so that buttons are not replaced while
   * they are pressed.
   */
  private update(control: Control | undefined): void {
    const controlJson = control && toJsonString(ControlSchema, { ...control, expireTime: undefined });
    const state = `${this.name} ${controlJson}`;
    if (state === this.lastState) return;
    this.lastState = state;
    this.roles.set(rolesOf(control, this.name));
  }

  /** Joins the session if the user has a name, and renews the participation. */
  async run(): Promise<void> {
    for (;;) {
      if (this.name !== "" || this.identity.name !== "") await this.enter(this.identity.name);
      await this.clock.sleep(renewalInterval);
    }
  }

  /** Joins the session under this name; returns true on success. */
  async enter(name: string): Promise<boolean> {
    return this.call(async () => {
      const answer = await this.api.control.enterSession({ ...this.session, name, timeToLive });
      this.identity.name = name;
      this.name = name;
      return answer;
    });
  }

  /** Takes control if this is allowed, or asks for it; returns true on success. */
  requestControl(): Promise<boolean> {
    return this.call(() => this.api.control.takeControl(this.session));
  }

  /** Hands control to another participant; returns true on success. */
  handOver(name: string): Promise<boolean> {
    return this.call(() => this.api.control.handControl({ ...this.session, to: { case: "name", value: name } }));
  }

  /** Lets everyone control the session; returns true on success. */
  openToEveryone(): Promise<boolean> {
    return this.call(() => this.api.control.handControl({ ...this.session, to: { case: "everybody", value: true } }));
  }

  /** Gives control back, or withdraws the request; returns true on success. */
  release(): Promise<boolean> {
    return this.call(() => this.api.control.releaseControl(this.session));
  }

  private get session() {
    return { sessionId: this.controller.sessionId };
  }

  private async call(call: () => Promise<{ control?: Control }>): Promise<boolean> {
    try {
      const { control } = await call();
      if (control !== undefined) this.controller.receiveControl(control);
      this.errorMessage.set("");
      return true;
    } catch (error) {
      this.errorMessage.set(errorText(error));
      return false;
    }
  }
}

/** True unless the owner decides who controls the session. */
export const isOpenToEveryone = (roles: Roles) => roles.control?.policy !== ControlPolicy.OWNER;
