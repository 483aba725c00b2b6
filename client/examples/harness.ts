// An evaluation script in TypeScript over Connect (gRPC-web): starts a study on a server, prints its progress and the
// recommended integrator. The study continues on the server if this script ends.
//
//   cd web && npm run harness -- http://127.0.0.1:8080 cube-tensegrity
import { createClient } from "@connectrpc/connect";
import { createGrpcWebTransport } from "@connectrpc/connect-web";
import { type Study, StudyService, StudyState } from "../../web/src/gen/phrenic/v1/study_pb";

/** Runs an error study of `scene` on the server at `baseUrl` to its end. `onProgress` receives each state. */
export async function studyError(baseUrl: string, scene: string, onProgress: (study: Study) => void): Promise<Study> {
  const client = createClient(StudyService, createGrpcWebTransport({ baseUrl }));
  const created = await client.createStudy({
    source: { source: { case: "name", value: scene } },
    what: { case: "error", value: { seconds: 1, levels: 4 } },
  });
  let last = created.study;
  for await (const { study } of client.watchStudy({ studyId: last?.id ?? "" })) {
    if (study === undefined) continue;
    last = study;
    onProgress(study);
  }
  if (last?.state !== StudyState.DONE) throw new Error(last?.problem ?? "the study did not end");
  await client.deleteStudy({ studyId: last.id });
  return last;
}

async function main(): Promise<void> {
  const [baseUrl = "http://127.0.0.1:8080", scene = "cube-tensegrity"] = process.argv.slice(2);
  const study = await studyError(baseUrl, scene, ({ progress, doing }) => {
    process.stderr.write(`\r${(100 * progress).toFixed(0)} % ${doing}\u001b[K`);
  });
  process.stderr.write("\n");
  const result = study.result?.result;
  if (result?.case !== "error") throw new Error("the server sent another kind of study");
  for (const row of result.value.rows.filter(({ pareto }) => pareto)) {
    console.log(`${row.integrator} at ${row.timeStepS} s: ${row.errorRmsMm} mm, ${row.cpuPerSecond} CPU s per second`);
  }
  console.log(result.value.advice);
}

if (process.argv[1]?.endsWith("harness.ts")) await main();
