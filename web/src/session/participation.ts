import { toJsonString } from "@bufbuild/protobuf";
import { type Api, errorText } from "../connection/api";
import type { Identity } from "../connection/identity";
import { type Control, ControlPolicy, ControlSchema } from "../gen/phrenic/v1/control_pb";
import { Signal } from "../state/signal";
import type { Clock } from "../timing/clock";
import type { Controller } from "./session_controller";

/** How often to say that one is still there [ms]; the server forgets who does not, after `stay` [s]. */
const renewal = 10_000;
const stay = 30;

/** Who controls the session, and what this viewer is in it. */
export interface Roles {
  control: Control | undefined;
  /** The name under which this viewer has entered; empty: they watch. */
  me: string;
  owner: boolean;
  /** Whether this viewer is the only one who may change the session. */
  alone: boolean;
  mayChange: boolean;
  /** Whether they may hand control on. */
  mayHand: boolean;
  asks: boolean;
}

export function rolesOf(control: Control | undefined, me: string): Roles {
  const self = control?.participants.find(({ name }) => name === me && me !== "");
  const alone = self !== undefined && control?.controller === self.name;
  const owner = self?.owner ?? false;
  const mayChange = alone || (control?.controller ?? "") === "";
  return { control, me: self?.name ?? "", owner, alone, mayChange, mayHand: alone || owner, asks: self?.asks ?? false };
}

/** Who controls, in words: "You control", "Anna controls", "Everybody controls". */
export function controlWords({ control, alone }: Roles): string {
  if (alone) return "You control";
  return control?.controller ? `${control.controller} controls` : "Everybody controls";
}

/** Why this viewer's controls are disabled; empty where they are not. */
export function refusalWords({ control, mayChange }: Roles): string {
  return mayChange ? "" : `${control?.controller} controls this session: ask for control, or fork it under "Share".`;
}

/** This viewer's part in a session: enters it under their name, stays, and asks for what roles allow. */
export class Standing {
  readonly roles = new Signal<Roles>(rolesOf(undefined, ""));
  /** What the server last had against it; empty when all is well. */
  readonly fault = new Signal("");
  private me = "";
  private told = "";

  constructor(
    private readonly api: Api,
    private readonly controller: Controller,
    readonly identity: Identity,
    private readonly clock: Clock,
  ) {
    controller.session.subscribe((session) => this.tell(session?.control));
  }

  /** A session's state comes every second: buttons are not made anew under somebody's finger when nothing changed. */
  private tell(control: Control | undefined): void {
    const words = control && toJsonString(ControlSchema, { ...control, expireTime: undefined });
    const news = `${this.me} ${words}`;
    if (news === this.told) return;
    this.told = news;
    this.roles.set(rolesOf(control, this.me));
  }

  /** Enters where this person has a name, and says again and again that they are there. */
  async run(): Promise<void> {
    for (;;) {
      if (this.me !== "" || this.identity.name !== "") await this.enter(this.identity.name);
      await this.clock.sleep(renewal);
    }
  }

  /** Whether the others see this viewer under that name from now on. */
  async enter(name: string): Promise<boolean> {
    return this.ask(async () => {
      const answer = await this.api.control.enterSession({ ...this.session, name, timeToLive: stay });
      this.identity.name = name;
      this.me = name;
      return answer;
    });
  }

  take(): Promise<boolean> {
    return this.ask(() => this.api.control.takeControl(this.session));
  }

  hand(name: string): Promise<boolean> {
    return this.ask(() => this.api.control.handControl({ ...this.session, to: { case: "name", value: name } }));
  }

  lend(): Promise<boolean> {
    return this.ask(() => this.api.control.handControl({ ...this.session, to: { case: "everybody", value: true } }));
  }

  release(): Promise<boolean> {
    return this.ask(() => this.api.control.releaseControl(this.session));
  }

  private get session() {
    return { sessionId: this.controller.sessionId };
  }

  private async ask(call: () => Promise<{ control?: Control }>): Promise<boolean> {
    try {
      const { control } = await call();
      if (control !== undefined) this.controller.receiveControl(control);
      this.fault.set("");
      return true;
    } catch (error) {
      this.fault.set(errorText(error));
      return false;
    }
  }
}

export const everybodys = (roles: Roles) => roles.control?.policy !== ControlPolicy.OWNER;
