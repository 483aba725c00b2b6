import { type Structure, Structures } from "../anatomy/structures";
import type { LayerStyles } from "../appearance/layer_styles";
import { make } from "../dom/elements";
import type { Body } from "../geometry/bodies";
import type { VertexRef } from "../geometry/vertices";
import { structureCard } from "../panels/view/structure_card";
import { structureSearch } from "../panels/view/structure_search";
import { Signal } from "../state/signal";
import type { Name } from "../viewer/names";
import type { Viewer } from "../viewer/viewer";

/** The names of structures: beside the resting pointer, in a card after a click, and in a search field. */
export class SceneStructures {
  readonly card: HTMLElement;
  readonly search: HTMLElement;
  readonly label = make("output", { id: "structure-label", hidden: true });
  /** The only structure that is not faded; undefined while all are shown. */
  readonly isolated = new Signal<Structure | undefined>(undefined);
  private readonly chosen = new Signal<Structure | undefined>(undefined);
  private structures = new Structures([]);
  private bodies: Body[] = [];

  constructor(
    private readonly viewer: Viewer,
    private readonly layerStyles: LayerStyles,
    measure?: (structure: Structure) => void,
  ) {
    const actions = { isolate: (each: Structure) => this.isolate(each), showAll: () => this.showAll(), measure };
    this.card = structureCard(this.chosen, this.isolated, actions);
    this.search = structureSearch({
      search: (text) => this.structures.search(text),
      choose: (structure) => {
        this.chosen.set(structure);
        this.isolate(structure);
      },
      leave: () => this.showAll(),
    });
    viewer.enableHover((vertex, x, y) => this.showLabel(vertex, x, y));
  }

  /** Starts another scene, which the viewer shows already. */
  start(bodies: Body[]): void {
    this.bodies = bodies;
    this.structures = new Structures(bodies);
    this.chosen.set(undefined);
    this.isolated.set(undefined);
    this.search.hidden = this.structures.all.length === 0;
  }

  /** Shows the name of the structure at a vertex; closes the card if it has none. */
  choose(vertex: VertexRef | undefined): void {
    this.chosen.set(vertex && this.structures.at(vertex));
  }

  /** Returns the name of the structure at a vertex, or of its layer in scenes without structures. */
  nameAt(vertex: VertexRef): Name | undefined {
    if (this.structures.all.length > 0) {
      const structure = this.structures.at(vertex);
      return structure && { name: structure.name, latin: structure.latin, structure: true };
    }
    const layer = this.bodies.find(({ name }) => name === vertex.body)?.layerTitle;
    return layer === undefined ? undefined : { name: layer, latin: "", structure: false };
  }

  /** Returns the structure at a vertex; undefined if it has no name. */
  at(vertex: VertexRef): Structure | undefined {
    return this.structures.at(vertex);
  }

  /** Shows all structures again, from where they were seen before. */
  showAll(): void {
    if (this.isolated.value === undefined) return;
    this.isolated.set(undefined);
    this.viewer.isolate(undefined);
  }

  private isolate(structure: Structure): void {
    const layer = this.bodies.find(({ name }) => name === structure.body)?.layer ?? "";
    if (this.layerStyles.get(layer)?.visible === false) this.layerStyles.change(layer, { visible: true });
    this.isolated.set(structure);
    this.viewer.isolate(structure);
  }

  private showLabel(vertex: VertexRef | undefined, x: number, y: number): void {
    const structure = vertex && this.structures.at(vertex);
    this.label.hidden = structure === undefined;
    if (structure === undefined) return;
    this.label.replaceChildren(structure.name, make("span", { className: "latin", lang: "la" }, structure.latin));
    this.label.style.transform = `translate(${x + 16}px, ${y + 16}px)`;
  }
}
