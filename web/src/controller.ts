import type { MessageInitShape } from "@bufbuild/protobuf";
import { type Api, errorText, unreachable } from "./api";
import type { Clock } from "./clock";
import type { Control } from "./gen/phrenic/v1/control_pb";
import type { ParametersSchema } from "./gen/phrenic/v1/parameters_pb";
import type { Preset } from "./gen/phrenic/v1/scene_pb";
import { type PullSchema, type Session, SessionState } from "./gen/phrenic/v1/session_pb";
import { NewestWins } from "./newest";
import { parameterControls, type ParameterName } from "./schema";
import { Signal } from "./signal";
import { Undo, type Values } from "./undo";

type PullValues = MessageInitShape<typeof PullSchema>;
type ParameterValues = Omit<MessageInitShape<typeof ParametersSchema>, "$typeName">;

/** How fast to play: simulated seconds a second, or as fast as the machine can. */
export type Speed = number | "fastest";

/** What a viewer asks of one session; each answer is shown at once, each refusal in the server's words. */
export class Controller {
  readonly session = new Signal<Session | undefined>(undefined);
  /** What the server last had to say against or about what was asked; empty when all is well. */
  readonly notice = new Signal("");
  private readonly updates: NewestWins<ParameterValues>;
  private readonly pulls: NewestWins<Record<string, PullValues>>;
  /** What this viewer changed. */
  readonly changes = new Undo();
  /** Another session that plays, pauses, steps and is reset with this one. */
  companion: Controller | undefined;

  constructor(
    private readonly api: Api,
    readonly sessionId: string,
    private readonly clock: Clock,
  ) {
    // Whatever became of a change, the controls show what holds.
    const showAll = () => this.session.set(this.session.value);
    this.updates = new NewestWins<ParameterValues>((change) => this.send(change), clock, showAll);
    this.pulls = new NewestWins(
      (change) => this.sendPulls(Object.values(change).filter((pull) => pull !== undefined)),
      clock,
      () => undefined,
    );
  }

  /** Takes in the state of the session, unless it is older than what is known and `fresh` is not said. */
  receive(session: Session | undefined, fresh = false): void {
    const known = this.session.value;
    if (session === undefined) return;
    if (fresh) this.notice.set("");
    if (!fresh && known !== undefined) {
      if (session.revision < known.revision) return;
      // Control changes beside all else: a state may be new and still be older in this.
      if ((session.control?.revision ?? 0n) < (known.control?.revision ?? 0n)) session.control = known.control;
    }
    this.session.set(session);
  }

  /** Takes in who controls the session, unless that is older than what is known. */
  receiveControl(control: Control): void {
    const known = this.session.value;
    if (known === undefined || control.revision < (known.control?.revision ?? 0n)) return;
    this.session.set({ ...known, control });
  }

  play(speed: Speed): Promise<void> {
    void this.companion?.play(speed);
    const pace = speed === "fastest" ? { asFastAsPossible: true } : { speed };
    return this.ask(() => this.api.sessions.playSession({ sessionId: this.sessionId, ...pace }));
  }

  pause(): Promise<void> {
    void this.companion?.pause();
    return this.ask(() => this.api.sessions.pauseSession({ sessionId: this.sessionId }));
  }

  step(ticks: number): Promise<void> {
    void this.companion?.step(ticks);
    return this.ask(() => this.api.sessions.stepSession({ sessionId: this.sessionId, ticks: BigInt(ticks) }));
  }

  reset(): Promise<void> {
    void this.companion?.reset();
    return this.ask(() => this.api.sessions.resetSession({ sessionId: this.sessionId }));
  }

  set(name: ParameterName, value: number | boolean): void {
    const before = this.session.value?.parameters?.[name];
    if (before !== undefined && before !== value)
      this.changes.note({ [name]: before }, { [name]: value }, this.clock.now());
    this.updates.push({ [name]: value });
  }

  /** Takes this viewer's last change back, or does again what was taken back. */
  undo(): void {
    this.setAll(this.changes.undo());
  }

  redo(): void {
    this.setAll(this.changes.redo());
  }

  /** Every parameter back to what a session of this scene starts with. */
  async resetAll(): Promise<void> {
    const start = await this.startValues();
    if (start !== undefined) await this.noted(() => this.send(start));
  }

  /** Pulls a vertex by a force [N] from now on; zero lets go of it. */
  pull(body: string, vertex: number, [x, y, z]: [number, number, number]): void {
    this.pulls.push({ [`${body}:${vertex}`]: { body, vertex, force: { x, y, z } } });
  }

  /** The page goes: what waits to be sent goes now. */
  leave(): void {
    this.updates.flush();
    this.pulls.flush();
  }

  /** Lets go of every vertex, whoever pulls it. */
  letGo(): Promise<void> {
    return this.ask(() => this.api.sessions.pullSession({ sessionId: this.sessionId, releaseOthers: true }));
  }

  /** Sets at once and resolves when it holds: for what must come before something else. */
  apply(parameters: ParameterValues): Promise<void> {
    return this.send(parameters);
  }

  /** Whether this viewer's own change of `name` is still on its way. */
  pending(name: ParameterName): boolean {
    return this.updates.pending(name);
  }

  /** Sets what belongs to one of the scene's presets. */
  usePreset(preset: string): Promise<void> {
    return this.noted(() => this.send({}, preset));
  }

  /**
   * Another session that stands where this one stands, by a preset where one is named, playing where this one plays;
   * nothing where there is none.
   */
  async fork(preset = ""): Promise<string | undefined> {
    const { sessions } = this.api;
    try {
      const sessionId = (await sessions.forkSession({ sessionId: this.sessionId })).session?.id;
      const playing = this.session.value?.state === SessionState.PLAYING;
      if (sessionId !== undefined && preset !== "")
        await sessions.updateParameters({ sessionId, parameters: {}, preset });
      if (sessionId !== undefined && playing) await sessions.playSession({ sessionId });
      return sessionId;
    } catch (error) {
      this.notice.set(errorText(error));
      return undefined;
    }
  }

  private setAll(values: Values | undefined): void {
    if (values !== undefined) this.updates.push(values);
  }

  /** Takes note of what `change` makes of the parameters. */
  private async noted(change: () => Promise<void>): Promise<void> {
    const before = { ...this.session.value?.parameters } as unknown as Values;
    await change();
    const after = { ...this.session.value?.parameters } as unknown as Values;
    const names = parameterControls().map(({ field }) => field);
    const changed = names.filter((name) => before[name] !== undefined && before[name] !== after[name]);
    const part = (values: Values) => Object.fromEntries(changed.map((name) => [name, values[name]]));
    if (changed.length > 0) this.changes.note(part(before), part(after), this.clock.now());
  }

  /** The values that a session of this scene starts with. */
  async startValues(): Promise<ParameterValues | undefined> {
    try {
      return (await this.describe()).parameters;
    } catch (error) {
      this.notice.set(errorText(error));
      return undefined;
    }
  }

  /** The scene's ways to breathe; none for a scene that is not in the server's catalogue. */
  async presets(): Promise<Preset[]> {
    try {
      return (await this.describe()).scene?.presets ?? [];
    } catch {
      return [];
    }
  }

  private describe() {
    const name = this.session.value?.scene ?? "";
    return this.api.scenes.describeScene({ source: { source: { case: "name", value: name } } });
  }

  private send(parameters: ParameterValues, preset = ""): Promise<void> {
    return this.ask(async () => {
      const answer = await this.api.sessions.updateParameters({ sessionId: this.sessionId, parameters, preset });
      return { session: answer.session, notice: answer.warnings.join(" ") };
    });
  }

  private sendPulls(pulls: PullValues[]): Promise<void> {
    return this.ask(() => this.api.sessions.pullSession({ sessionId: this.sessionId, pulls }));
  }

  private async ask(call: () => Promise<{ session?: Session; notice?: string }>): Promise<void> {
    try {
      const { session, notice } = await call();
      this.receive(session);
      this.notice.set(notice ?? "");
    } catch (error) {
      // That the server is gone is said by the connection.
      if (!unreachable(error)) this.notice.set(errorText(error));
    }
  }
}
