import { fromJsonString, type JsonObject, toJson } from "@bufbuild/protobuf";
import type { Api } from "../connection/api";
import { type Parameters, ParametersSchema } from "../gen/phrenic/v1/parameters_pb";
import type { Session } from "../gen/phrenic/v1/session_pb";

/** The inputs of a simulation: the same scene with the same parameters reaches the same state, bit for bit. */
export interface RunRecipe {
  scene: string;
  hash: string;
  parameters: Parameters;
  tick: number;
}

/** Steps per call, between which progress is reported. */
const stride = 1000;

/** Returns the query string that runs this session again from its start, with its current parameters, to its tick. */
export function permalinkOf({ scene, parameters, tick }: Session, hash: string): string {
  const json =
    parameters === undefined ? {} : (toJson(ParametersSchema, parameters, { useProtoFieldName: true }) as JsonObject);
  const query = new URLSearchParams({ scene, hash, tick: String(tick), parameters: JSON.stringify(json) });
  return `?${query}`;
}

/** Parses an address; undefined if it names no scene. Throws Error for invalid values. */
export function recipeOf(address: URL): RunRecipe | undefined {
  const get = (name: string) => address.searchParams.get(name) ?? "";
  if (get("scene") === "") return undefined;
  const tick = Number(get("tick") || "0");
  if (!Number.isInteger(tick) || tick < 0) throw new Error(`tick: ${get("tick")} is not a number of steps`);
  const parameters = fromJsonString(ParametersSchema, get("parameters") || "{}");
  return { scene: get("scene"), hash: get("hash"), parameters, tick };
}

/**
 * Runs a recipe and returns the id of the paused session. `progress` is called with a fraction from 0 to 1. Throws
 * Error if the scene has another hash.
 */
export async function rerun(api: Api, recipe: RunRecipe, progress: (part: number) => void): Promise<string> {
  const source = { source: { case: "name" as const, value: recipe.scene } };
  const { session } = await api.sessions.createSession({ source, parameters: recipe.parameters });
  const sessionId = session?.id ?? "";
  const { report } = await api.sessions.getSession({ sessionId });
  if (recipe.hash !== "" && report?.sceneHash !== recipe.hash) {
    await api.sessions.deleteSession({ sessionId });
    throw new Error(
      `the scene "${recipe.scene}" differs on this server: its hash is ${report?.sceneHash.slice(0, 12)}…, not ${recipe.hash.slice(0, 12)}…`,
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
