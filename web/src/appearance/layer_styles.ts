import type { CompileReport } from "../gen/phrenic/v1/report_pb";
import type { Body } from "../geometry/bodies";
import { Signal } from "../state/signal";

/** How a layer is shown in this viewer; nobody else sees it. */
export interface Look {
  layer: string;
  title: string;
  color: string;
  opacity: number;
  visible: boolean;
}

/** The looks of all layers, in the scene's order. */
export class Looks {
  readonly all = new Signal<Look[]>([]);
  /** The layer that the simulation is about: the one with the most simulated vertices. */
  main = "";

  start(bodies: Body[], report: CompileReport): void {
    const looks = new Map<string, Look>();
    for (const { layer, layerTitle, color, opacity } of bodies) {
      if (!looks.has(layer)) looks.set(layer, { layer, title: layerTitle, color, opacity, visible: true });
    }
    this.main = mainLayer(report);
    this.all.set([...looks.values()]);
  }

  change(layer: string, change: Partial<Look>): void {
    this.all.set(this.all.value.map((look) => (look.layer === layer ? { ...look, ...change } : look)));
  }

  get(layer: string): Look | undefined {
    return this.all.value.find((look) => look.layer === layer);
  }
}

function mainLayer(report: CompileReport): string {
  const counts = new Map<string, number>();
  for (const { name, layer, simulatedVertices } of report.bodies) {
    const key = layer || name;
    counts.set(key, (counts.get(key) ?? 0) + Number(simulatedVertices));
  }
  return [...counts].sort((a, b) => b[1] - a[1])[0]?.[0] ?? "";
}
