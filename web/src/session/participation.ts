import { toJsonString } from "@bufbuild/protobuf";
import { type Api, errorText } from "../connection/api";
import type { Identity } from "../connection/identity";
import { type Control, ControlPolicy, ControlSchema } from "../gen/phrenic/v1/control_pb";
import { Signal } from "../state/signal";
import type { Clock } from "../timing/clock";
import type { SessionController } from "./session_controller";

/** How often to say that one is still there [ms]; the server forgets who does not, after `stay` [s]. */
const renewalInterval = 10_000;
const timeToLive = 30;

/** Who controls the session, and what this viewer is in it. */
export interface Roles {
  control: Control | undefined;
  /** The name under which this viewer has entered; empty: they watch. */
  name: string;
  isOwner: boolean;
  /** Whether this viewer is the only one who may change the session. */
  hasControl: boolean;
  mayChange: boolean;
  /** Whether they may hand control on. */
  mayHandOver: boolean;
  hasRequested: boolean;
}

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

/** Who controls, in words: "You control", "Anna controls", "Everybody controls". */
export function controlLabel({ control, hasControl }: Roles): string {
  if (hasControl) return "You control";
  return control?.controller ? `${control.controller} controls` : "Everybody controls";
}

/** Why this viewer's controls are disabled; empty where they are not. */
export function refusalReason({ control, mayChange }: Roles): string {
  return mayChange ? "" : `${control?.controller} controls this session: ask for control, or fork it under "Share".`;
}

/** This viewer's part in a session: enters it under their name, stays, and asks for what roles allow. */
export class Participation {
  readonly roles = new Signal<Roles>(rolesOf(undefined, ""));
  /** What the server last had against it; empty when all is well. */
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

  /** A session's state comes every second: buttons are not made anew under somebody's finger when nothing changed. */
  private update(control: Control | undefined): void {
    const controlJson = control && toJsonString(ControlSchema, { ...control, expireTime: undefined });
    const state = `${this.name} ${controlJson}`;
    if (state === this.lastState) return;
    this.lastState = state;
    this.roles.set(rolesOf(control, this.name));
  }

  /** Enters where this person has a name, and says again and again that they are there. */
  async run(): Promise<void> {
    for (;;) {
      if (this.name !== "" || this.identity.name !== "") await this.enter(this.identity.name);
      await this.clock.sleep(renewalInterval);
    }
  }

  /** Whether the others see this viewer under that name from now on. */
  async enter(name: string): Promise<boolean> {
    return this.call(async () => {
      const answer = await this.api.control.enterSession({ ...this.session, name, timeToLive });
      this.identity.name = name;
      this.name = name;
      return answer;
    });
  }

  requestControl(): Promise<boolean> {
    return this.call(() => this.api.control.takeControl(this.session));
  }

  handOver(name: string): Promise<boolean> {
    return this.call(() => this.api.control.handControl({ ...this.session, to: { case: "name", value: name } }));
  }

  openToEveryone(): Promise<boolean> {
    return this.call(() => this.api.control.handControl({ ...this.session, to: { case: "everybody", value: true } }));
  }

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

export const isOpenToEveryone = (roles: Roles) => roles.control?.policy !== ControlPolicy.OWNER;
