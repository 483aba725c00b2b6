/** Pictures of the steps of a lesson, as addresses of this page. */
export class StepPictures {
  private readonly kept = new Map<number, string>();
  /** Changes when the pictures are cleared: one that is still being made then is dropped. */
  private run = 0;

  /** Addresses by the number of the step, from 1. */
  get byStep(): ReadonlyMap<number, string> {
    return this.kept;
  }

  /** Keeps the picture of a step instead of the one before; keeps that if the browser could make none. */
  async keep(step: number, making: Promise<Blob | null>): Promise<void> {
    const { run } = this;
    const picture = await making;
    if (picture === null || run !== this.run) return;
    this.release(step);
    this.kept.set(step, URL.createObjectURL(picture));
  }

  /** Releases all pictures. */
  clear(): void {
    this.run++;
    for (const step of [...this.kept.keys()]) this.release(step);
  }

  private release(step: number): void {
    const url = this.kept.get(step);
    if (url !== undefined) URL.revokeObjectURL(url);
    this.kept.delete(step);
  }
}
