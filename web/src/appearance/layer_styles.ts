import type { CompileReport } from "../gen/phrenic/v1/report_pb";
import type { Body } from "../geometry/bodies";
import { Signal } from "../state/signal";

/** How this viewer shows a layer; not shared with other viewers. */
export interface LayerStyle {
  layer: string;
  title: string;
  color: string;
  opacity: number;
  visible: boolean;
}

/** The styles of all layers in the order of the scene. */
export class LayerStyles {
  readonly all = new Signal<LayerStyle[]>([]);
  /** The layer with the most vertices of tissue. */
  mainLayer = "";

  /** Starts another scene with the styles that it defines. */
  start(bodies: Body[], report: CompileReport): void {
    const styles = new Map<string, LayerStyle>();
    for (const { layer, layerTitle, color, opacity } of bodies) {
      if (!styles.has(layer)) styles.set(layer, { layer, title: layerTitle, color, opacity, visible: true });
    }
    this.mainLayer = mainLayer(report);
    this.all.set([...styles.values()]);
  }

  /** Changes some properties of a layer's style. */
  change(layer: string, change: Partial<LayerStyle>): void {
    this.all.set(this.all.value.map((style) => (style.layer === layer ? { ...style, ...change } : style)));
  }

  /** Returns the style of a layer; undefined for an unknown layer. */
  get(layer: string): LayerStyle | undefined {
    return this.all.value.find((style) => style.layer === layer);
  }
}

function mainLayer(report: CompileReport): string {
  const counts = new Map<string, number>();
  for (const { name, layer, tissue, vertices } of report.bodies) {
    const key = layer || name;
    counts.set(key, (counts.get(key) ?? 0) + (tissue ? Number(vertices) : 0));
  }
  return [...counts].sort((a, b) => b[1] - a[1])[0]?.[0] ?? "";
}
