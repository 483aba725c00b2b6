import { createGrpcWebTransport } from "@connectrpc/connect-web";
import { createApi } from "./src/connection/api";
const fr: typeof fetch = (i, n) => fetch(i, { ...n, redirect: "follow" });
const api = createApi(createGrpcWebTransport({ baseUrl: process.argv[2], fetch: fr }));
const runs = JSON.parse(process.argv[3]) as [string, string, object][];
for (const [label, preset, parameters] of runs) {
  const { session } = await api.sessions.createSession({ source: { source: { case: "name", value: "thorax" } }, preset, parameters });
  const id = session!.id, p = session!.parameters!;
  const dt = p.timeStep!, T = p.breathLength!;
  const per = Math.max(1, Math.round(0.05 / dt));
  await api.sessions.stepSession({ sessionId: id, ticks: BigInt(Math.round((2 * T) / dt)) });
  const rows: Record<string, number[]> = {};
  for (let t = 0; t <= T; t += per * dt) {
    const { measures } = await api.sessions.stepSession({ sessionId: id, ticks: BigInt(per) });
    for (const m of measures) (rows[m.name] ??= []).push(m.value);
  }
  const v = rows["lung volume"]; const lo = v.indexOf(Math.min(...v)), hi = v.indexOf(Math.max(...v));
  const out: string[] = [];
  for (const [n, x] of Object.entries(rows)) { const f = n.includes("dome") ? 1000 : n.includes("pressure") ? 1/98.07 : n.includes("volume")||n.includes("flow")||n.includes("displ") ? 1000 : 1;
    out.push(`${n}: min ${(f*Math.min(...x)).toFixed(2)} max ${(f*Math.max(...x)).toFixed(2)} insp ${(f*(x[hi]-x[lo])).toFixed(2)}`); }
  console.log(`## ${label} T=${T} dt=${dt}\n  ` + out.join("\n  "));
  await api.sessions.deleteSession({ sessionId: id });
}
