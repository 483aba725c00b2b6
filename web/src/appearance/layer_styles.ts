import type { CompileReport } from "../gen/phrenic/v1/report_pb";
import { Placement } from "../gen/phrenic/v1/frames_pb";
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
  /** Layers that the scene hides and this viewer has not shown yet. */
  private readonly unseen = new Set<string>();
  private hiddenByScene: ReadonlySet<string> = new Set();
  /** Names of the scene's bodies. */
  bodyNames: string[] = [];

  /** Starts another scene with the styles that it defines; layers of opacity 0 are hidden, and opaque once shown. */
  start(bodies: Body[], report: CompileReport): void {
    const styles = new Map<string, LayerStyle>();
    for (const { layer, layerTitle, color, opacity } of bodies) {
      const style = { layer, title: layerTitle, color, opacity: opacity || 1, visible: opacity > 0 };
      if (!styles.has(layer)) styles.set(layer, style);
    }
    this.bodyNames = bodies.map(({ name }) => name);
    this.unseen.clear();
    for (const { layer, visible } of styles.values()) if (!visible) this.unseen.add(layer);
    this.hiddenByScene = new Set(this.unseen);
    this.mainLayer = mainLayer(report);
    this.all.set([...styles.values()]);
  }

  /** True unless the scene hides this layer. */
  shownByScene(layer: string): boolean {
    return !this.hiddenByScene.has(layer);
  }

  /** Changes some properties of a layer's style. */
  change(layer: string, change: Partial<LayerStyle>): void {
    if (change.visible === true) this.unseen.delete(layer);
    this.all.set(this.all.value.map((style) => (style.layer === layer ? { ...style, ...change } : style)));
  }

  /**
   * Returns the streamed bodies whose positions this viewer needs, by name; empty for all. A layer that was shown once
   * is needed from then on, so that the server encodes few selections of bodies.
   */
  neededBodies(bodies: Body[]): string[] {
    const streamed = bodies.filter(({ placement }) => placement === Placement.STREAMED);
    const needed = streamed.filter(({ layer }) => !this.unseen.has(layer));
    return needed.length === streamed.length ? [] : needed.map(({ name }) => name);
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
