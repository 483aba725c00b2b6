import { count } from "./format";

/** Says how many runs a study is of, and how many failed: "56 runs; 2 failed: ...". */
export function runsSentence({ runs, failed, problem }: { runs: bigint; failed: bigint; problem: string }): string {
  const all = count(Number(runs), "run");
  return failed > 0n ? `${all}; ${failed} FAILED and are left out: ${problem}.` : `${all}; none failed.`;
}
