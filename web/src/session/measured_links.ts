import { faultOfMeasurement, type KeptMeasurement, mostMeasurements } from "../geometry/measuring";

const key = "measure";

/** Returns the query string with measurements in it: "measure=distance:BODY,x,y,z:BODY,x,y,z", places at rest [mm]. */
export function withMeasurements(query: string, kept: KeptMeasurement[]): string {
  const parameters = new URLSearchParams(query);
  parameters.delete(key);
  for (const { tool, points } of kept) {
    const places = points.map(({ body, rest }) => [encodeURIComponent(body), ...rest.map(millimetres)].join(","));
    parameters.append(key, [tool, ...places].join(":"));
  }
  return `?${parameters}`;
}

/** Parses the measurements of an address. Throws Error naming the one that is wrong. */
export function measurementsOf(address: URL): KeptMeasurement[] {
  const texts = address.searchParams.getAll(key);
  if (texts.length > mostMeasurements) throw new Error(`${key}: give at most ${mostMeasurements} measurements`);
  return texts.map((text, i) => {
    const [tool, ...places] = text.split(":");
    const points = places.map((place) => {
      const [body, ...coordinates] = place.split(",");
      const [x, y, z] = coordinates.map((each) => (each === "" ? NaN : Number(each) / 1000));
      return { body: nameOf(body), rest: { x, y, z: coordinates.length === 3 ? z : NaN } };
    });
    const fault = faultOfMeasurement(tool, points);
    if (fault !== undefined) throw new Error(`${key}[${i}].${fault}`);
    const kept = points.map(({ body, rest: { x, y, z } }) => ({ body, rest: [x, y, z] as const }));
    return { tool: tool as KeptMeasurement["tool"], points: kept };
  });
}

const millimetres = (metres: number) => String(Number((1000 * metres).toFixed(2)));

/** Returns a body's name from its encoded form; the text itself if it is not encoded well. */
function nameOf(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}
