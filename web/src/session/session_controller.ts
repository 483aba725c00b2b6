import type { MessageInitShape } from "@bufbuild/protobuf";
import { type Api, errorText, isUnreachable } from "../connection/api";
import type { Control } from "../gen/phrenic/v1/control_pb";
import type { ParametersSchema } from "../gen/phrenic/v1/parameters_pb";
import type { Preset } from "../gen/phrenic/v1/scene_pb";
import { type PullSchema, type Session, SessionState } from "../gen/phrenic/v1/session_pb";
import { parameterControls, type ParameterName } from "../parameters/controls";
import { Signal } from "../state/signal";
import { UndoHistory, type Values } from "../state/undo_history";
import type { Clock } from "../timing/clock";
import { CoalescingSender } from "../timing/coalescing_sender";

type PullValues = MessageInitShape<typeof PullSchema>;
type ParameterValues = Omit<MessageInitShape<typeof ParametersSchema>, "$typeName">;

/** How fast to play: simulated seconds a second, or as fast as the machine can. */
export type Speed = number | "fastest";

/** Farther apart two sessions do not find together by themselves [s]: the server's limit, too. */
const maxTimeDifference = 2;

/** What a viewer asks of one session; each answer is shown at once, each refusal in the server's words. */
export class SessionController {
  readonly session = new Signal<Session | undefined>(undefined);
  /** What the server last had to say against or about what was asked; empty when all is well. */
  readonly notice = new Signal("");
  private readonly updates: CoalescingSender<ParameterValues>;
  private readonly pulls: CoalescingSender<Record<string, PullValues>>;
  /** What this viewer changed. */
  readonly changes = new UndoHistory();
  /** Another session that plays, pauses, steps and is reset with this one. */
  companion: SessionController | undefined;

  constructor(
    private readonly api: Api,
    readonly sessionId: string,
    private readonly clock: Clock,
  ) {
    // Whatever became of a change, the controls show what holds.
    const showAll = () => this.session.set(this.session.value);
    this.updates = new CoalescingSender<ParameterValues>((change) => this.send(change), clock, showAll);
    this.pulls = new CoalescingSender(
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

  /** With a companion each waits for the other where it gets ahead. */
  play(speed: Speed): Promise<void> {
    void this.companion?.playSynchronised(speed, this.sessionId);
    return this.playSynchronised(speed, this.companion?.sessionId);
  }

  /** With a companion both come to rest at the same instant. */
  async pause(): Promise<void> {
    await Promise.all([this.pauseThis(), this.companion?.pauseThis()]);
    await this.alignTimes();
  }

  /** Two that play and have come apart stand still where the one behind has caught up, and go on in step. */
  async resynchronise(): Promise<void> {
    const speed = this.currentSpeed;
    await this.pause();
    await this.play(speed);
  }

  /** With a companion both have stepped as far in the end, also where one was still at its last steps. */
  async step(ticks: number): Promise<void> {
    await Promise.all([this.stepThis(ticks), this.companion?.stepThis(ticks)]);
    await this.alignTimes();
  }

  reset(): Promise<void> {
    void this.companion?.reset();
    return this.call(() => this.api.sessions.resetSession({ sessionId: this.sessionId }));
  }

  set(name: ParameterName, value: number | boolean): void {
    const before = this.session.value?.parameters?.[name];
    if (before !== undefined && before !== value)
      this.changes.record({ [name]: before }, { [name]: value }, this.clock.now());
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
    if (start !== undefined) await this.recordChange(() => this.send(start));
  }

  /** Pulls a vertex by a force [N] from now on; zero lets go of it. */
  pull(body: string, vertex: number, [x, y, z]: [number, number, number]): void {
    this.pulls.push({ [`${body}:${vertex}`]: { body, vertex, force: { x, y, z } } });
  }

  /** The page goes: what waits to be sent goes now. */
  flush(): void {
    this.updates.flush();
    this.pulls.flush();
  }

  /** Lets go of every vertex, whoever pulls it. */
  releasePulls(): Promise<void> {
    return this.call(() => this.api.sessions.pullSession({ sessionId: this.sessionId, releaseOthers: true }));
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
    return this.recordChange(() => this.send({}, preset));
  }

  /** Another session that stands where this one stands, playing where this one plays; nothing where there is none. */
  async fork(): Promise<string | undefined> {
    const fork = await this.createFork();
    if (fork !== undefined && this.playing) await fork.play(this.currentSpeed);
    return fork?.sessionId;
  }

  /**
   * A fork to be shown beside this session, by a preset where one is named: both start from one instant, and play in step
   * where this one plays.
   */
  async forkForComparison(preset = ""): Promise<string | undefined> {
    const [playing, speed] = [this.playing, this.currentSpeed];
    if (playing) await this.pause();
    const fork = await this.createFork();
    if (fork !== undefined && preset !== "") await fork.usePreset(preset);
    this.companion = fork;
    if (playing) await this.play(speed);
    return fork?.sessionId;
  }

  private get playing(): boolean {
    return this.session.value?.state === SessionState.PLAYING;
  }

  /** How fast it plays, or would. */
  private get currentSpeed(): Speed {
    return this.session.value?.speed || "fastest";
  }

  private async createFork(): Promise<SessionController | undefined> {
    try {
      const { session } = await this.api.sessions.forkSession({ sessionId: this.sessionId });
      return session === undefined ? undefined : new SessionController(this.api, session.id, this.clock);
    } catch (error) {
      this.notice.set(errorText(error));
      return undefined;
    }
  }

  private playSynchronised(speed: Speed, inStepWith = ""): Promise<void> {
    const pace = speed === "fastest" ? { asFastAsPossible: true } : { speed };
    return this.call(() => this.api.sessions.playSession({ sessionId: this.sessionId, inStepWith, ...pace }));
  }

  private pauseThis(): Promise<void> {
    return this.call(() => this.api.sessions.pauseSession({ sessionId: this.sessionId }));
  }

  private stepThis(ticks: number): Promise<void> {
    return this.call(() => this.api.sessions.stepSession({ sessionId: this.sessionId, ticks: BigInt(ticks) }));
  }

  /** Of two that stand the one behind goes on to where the other is, where that is near. */
  private async alignTimes(): Promise<void> {
    const { companion } = this;
    const apart = (companion?.session.value?.time ?? 0) - (this.session.value?.time ?? 0);
    if (companion === undefined || Math.abs(apart) > maxTimeDifference) return;
    const behind = apart > 0 ? this : companion;
    const ticks = Math.round(Math.abs(apart) / (behind.session.value?.parameters?.timeStep ?? Infinity));
    if (ticks > 0) await behind.stepThis(ticks);
  }

  private setAll(values: Values | undefined): void {
    if (values !== undefined) this.updates.push(values);
  }

  /** Takes note of what `change` makes of the parameters. */
  private async recordChange(change: () => Promise<void>): Promise<void> {
    const before = { ...this.session.value?.parameters } as unknown as Values;
    await change();
    const after = { ...this.session.value?.parameters } as unknown as Values;
    const names = parameterControls().map(({ field }) => field);
    const changed = names.filter((name) => before[name] !== undefined && before[name] !== after[name]);
    const part = (values: Values) => Object.fromEntries(changed.map((name) => [name, values[name]]));
    if (changed.length > 0) this.changes.record(part(before), part(after), this.clock.now());
  }

  /** The values that a session of this scene starts with. */
  async startValues(): Promise<ParameterValues | undefined> {
    try {
      return (await this.describeScene()).parameters;
    } catch (error) {
      this.notice.set(errorText(error));
      return undefined;
    }
  }

  /** The scene's ways to breathe; none for a scene that is not in the server's catalogue. */
  async presets(): Promise<Preset[]> {
    try {
      return (await this.describeScene()).scene?.presets ?? [];
    } catch {
      return [];
    }
  }

  private describeScene() {
    const name = this.session.value?.scene ?? "";
    return this.api.scenes.describeScene({ source: { source: { case: "name", value: name } } });
  }

  private send(parameters: ParameterValues, preset = ""): Promise<void> {
    return this.call(async () => {
      const answer = await this.api.sessions.updateParameters({ sessionId: this.sessionId, parameters, preset });
      return { session: answer.session, notice: answer.warnings.join(" ") };
    });
  }

  private sendPulls(pulls: PullValues[]): Promise<void> {
    return this.call(() => this.api.sessions.pullSession({ sessionId: this.sessionId, pulls }));
  }

  private async call(call: () => Promise<{ session?: Session; notice?: string }>): Promise<void> {
    try {
      const { session, notice } = await call();
      this.receive(session);
      this.notice.set(notice ?? "");
    } catch (error) {
      // That the server is gone is said by the connection.
      if (!isUnreachable(error)) this.notice.set(errorText(error));
    }
  }
}
