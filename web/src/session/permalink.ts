import { fromJsonString, type JsonObject, toJson } from "@bufbuild/protobuf";
import type { Api } from "../connection/api";
import { type Parameters, ParametersSchema } from "../gen/phrenic/v1/parameters_pb";
import type { Session } from "../gen/phrenic/v1/session_pb";

/** What a simulation can be run again from: the same scene with the same parameters comes to the same state, bit for bit. */
export interface RunRecipe {
  scene: string;
  hash: string;
  parameters: Parameters;
  tick: number;
}

/** Steps taken in one call, so that progress can be told. */
const stride = 1000;

/** The query of an address that runs this session again from its start, with its present parameters, to its tick. */
export function permalinkOf({ scene, parameters, tick }: Session, hash: string): string {
  const json =
    parameters === undefined ? {} : (toJson(ParametersSchema, parameters, { useProtoFieldName: true }) as JsonObject);
  const query = new URLSearchParams({ scene, hash, tick: String(tick), parameters: JSON.stringify(json) });
  return `?${query}`;
}

/** What an address asks to be run again; nothing where it names no scene. Error where it makes no sense. */
export function recipeOf(address: URL): RunRecipe | undefined {
  const get = (name: string) => address.searchParams.get(name) ?? "";
  if (get("scene") === "") return undefined;
  const tick = Number(get("tick") || "0");
  if (!Number.isInteger(tick) || tick < 0) throw new Error(`tick: ${get("tick")} is no number of steps`);
  const parameters = fromJsonString(ParametersSchema, get("parameters") || "{}");
  return { scene: get("scene"), hash: get("hash"), parameters, tick };
}

/** Runs a recipe: the id of a paused session at its tick. `progress` hears how far it is, 0 to 1. */
export async function rerun(api: Api, recipe: RunRecipe, progress: (part: number) => void): Promise<string> {
  const source = { source: { case: "name" as const, value: recipe.scene } };
  const { session } = await api.sessions.createSession({ source, parameters: recipe.parameters });
  const sessionId = session?.id ?? "";
  const { report } = await api.sessions.getSession({ sessionId });
  if (recipe.hash !== "" && report?.sceneHash !== recipe.hash) {
    await api.sessions.deleteSession({ sessionId });
    throw new Error(
      `the scene "${recipe.scene}" is another one here: its hash is ${report?.sceneHash.slice(0, 12)}…, not ${recipe.hash.slice(0, 12)}…`,
    );
  }
  for (let tick = 0; tick < recipe.tick;) {
    const ticks = Math.min(stride, recipe.tick - tick);
    await api.sessions.stepSession({ sessionId, ticks: BigInt(ticks), expectedTick: BigInt(tick) });
    tick += ticks;
    progress(tick / recipe.tick);
  }
  return sessionId;
}
