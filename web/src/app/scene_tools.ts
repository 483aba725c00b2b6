import { ColorScale, topFor } from "../appearance/color_scale";
import { Coloring } from "../appearance/coloring";
import { forceOf } from "../appearance/fields";
import { type GhostKind, Ghosts } from "../appearance/ghosts";
import type { Looks } from "../appearance/layer_styles";
import { LiveDistance } from "../appearance/live_distance";
import { Following } from "../appearance/tracked_vertices";
import { make } from "../dom/elements";
import type { Frame } from "../gen/phrenic/v1/frames_pb";
import type { Body, FrameArrays } from "../geometry/bodies";
import { appearancePanel } from "../panels/view/appearance_panel";
import { coloringCard } from "../panels/view/coloring_card";
import { OrientationCube } from "../panels/view/orientation_cube";
import { PickCard } from "../panels/view/pick_card";
import type { Comparisons } from "../session/comparisons";
import type { Forces, Wanted } from "../session/force_queries";
import { Signal } from "../state/signal";
import { Annotations } from "../viewer/annotations";
import type { Compass } from "../viewer/camera_rig";
import type { Cut } from "../viewer/clipping";
import type { OverlayKind } from "../viewer/overlays";
import type { Viewer } from "../viewer/viewer";

/** What a viewer does with the picture for itself: colours, ghost, names, axes, and vertices that are picked. */
export class SceneTools {
  readonly following = new Following(() => this.bodies);
  readonly panel: HTMLElement;
  /** Cards over the picture. */
  readonly cards: HTMLElement[];
  readonly cube: OrientationCube;
  readonly annotations: Annotations;
  readonly force = make("output", { id: "force", hidden: true });
  readonly coloring: Coloring;
  /** What is shown of every picture, also of one beside. */
  readonly overlays = new Signal<ReadonlySet<OverlayKind>>(new Set());
  readonly labels = new Signal(false);
  readonly cut = new Signal<Cut>({ kind: "none", part: 0.5, flipped: false });
  readonly ghost = new Signal<GhostKind>("none");
  private readonly pickCard: PickCard;
  private readonly ghosts: Ghosts;
  private bodies: Body[] = [];
  private moving: Body[] = [];
  private live: LiveDistance | undefined;
  private time = 0;
  /** The earlier moment that is shown [s]. */
  private back: number | undefined;

  constructor(
    private readonly viewer: Viewer,
    private readonly arrays: () => FrameArrays | undefined,
    looks: Looks,
    private readonly comparisons: Comparisons,
    private readonly forces: Forces,
  ) {
    this.coloring = new Coloring(forces);
    this.ghosts = new Ghosts(viewer, arrays, this.ghost);
    this.pickCard = new PickCard(this.following, forces.onVertex);
    this.annotations = new Annotations(viewer);
    this.cube = new OrientationCube((view) => viewer.go(view));
    this.cards = [coloringCard(this.coloring), this.pickCard.element];
    const { labels, ghost } = this;
    this.panel = appearancePanel({
      looks,
      labels,
      ghost,
      forceKinds: forces.kinds,
      overlays: this.overlays,
      coloring: this.coloring,
      setCut: (cut) => {
        const place = viewer.setCut(cut);
        this.annotations.start(looks.all.value);
        this.cut.set(cut);
        return place;
      },
    });
    labels.subscribe((on) => this.annotations.setLabels(on));
    looks.all.subscribe((all) => this.annotations.start(all));
    this.overlays.subscribe((shown) => viewer.showOverlays(shown));
    this.coloring.kind.subscribe(() => {
      this.note();
      this.recallForces();
    });
    this.coloring.scale.subscribe(() => this.paint());
    comparisons.result.subscribe((result) => {
      this.live = result === undefined ? undefined : new LiveDistance(result);
      this.drawTarget();
      this.paint();
    });
    comparisons.drawn.subscribe(() => this.drawTarget());
    forces.sizes.subscribe(() => this.paint());
    viewer.letClick((ref) => this.following.picked.set(ref));
    this.following.picked.subscribe(() => {
      this.recallForces();
      this.mark();
    });
    this.following.all.subscribe(() => this.mark());
  }

  /** Another scene, which the viewer shows already. */
  start(bodies: Body[], deformable: ReadonlySet<string>, diagram: boolean): void {
    this.bodies = bodies;
    this.moving = bodies.filter(({ name }) => deformable.has(name));
    this.coloring.start(this.moving);
    void this.forces.start(this.moving[0]?.name);
    this.following.clear();
    if (this.ghost.value === "now") this.ghost.set("none");
    this.ghosts.start(this.moving);
    // Which edges are rigid is what a diagram is about.
    if (diagram && bodies.some(({ rigidLinks }) => rigidLinks.length > 0))
      this.overlays.set(new Set([...this.overlays.value, "links"]));
  }

  receive(frame: Frame): void {
    this.ghosts.receive(frame);
  }

  /** A picture of the moment `time` [s] is about to be drawn from `arrays`. */
  update(time: number, arrays: FrameArrays): void {
    this.time = time;
    this.note();
    this.following.receive(time, arrays);
    if (this.coloring.kind.value !== undefined) this.paint();
    this.mark();
  }

  /** The colours follow the moment that is shown. */
  private note(): void {
    const arrays = this.arrays();
    if (arrays !== undefined) this.coloring.receive(this.time, arrays);
  }

  drawn(compass: Compass): void {
    this.cube.show(compass);
    this.annotations.draw();
  }

  /** Has the server tell the forces of the state that was seen last, where they are shown. */
  askForces(seen: string): void {
    void this.forces.ask(this.wanted(), seen);
  }

  /** An earlier moment is shown [s], or the present: with the forces that were told of it. */
  lookBack(time: number | undefined): void {
    this.back = time;
    this.recallForces();
  }

  private wanted(): Wanted {
    const kind = forceOf(this.coloring.kind.value);
    const picked = this.following.picked.value;
    const vertex = this.moving.some(({ name }) => name === picked?.body) ? picked : undefined;
    return { vertex, kind, bodies: kind === undefined ? [] : this.coloring.names };
  }

  private recallForces(): void {
    this.forces.recall(this.back, this.wanted());
    const unknown = this.back !== undefined && this.wanted().kind !== undefined && this.forces.sizes.value.size === 0;
    this.coloring.note.set(unknown ? "Not known of this moment: forces are kept while they are shown." : "");
  }

  /** Words, and the colours of a comparison, follow the picture a few times a second. */
  show(): void {
    const arrays = this.arrays();
    this.pickCard.show(arrays);
    if (arrays !== undefined && this.live?.follow(this.bodies, arrays, () => performance.now())) this.paint();
  }

  /** How hard the pointer pulls [N], beside it. */
  tellForce(newtons: number | undefined, x: number, y: number): void {
    this.force.hidden = newtons === undefined;
    if (newtons === undefined) return;
    this.force.textContent = `${newtons.toFixed(2)} N`;
    this.force.style.transform = `translate(${x + 14}px, ${y + 14}px)`;
  }

  /** A comparison's colours come before those of a field. */
  private paint(): void {
    const comparison = this.comparisons.result.value;
    if (comparison === undefined) return this.viewer.paint(this.coloring.paint());
    const { body, distances } = comparison;
    const scale = new ColorScale(topFor(distances));
    this.viewer.paint(new Map([[body, scale.paint(this.live?.values ?? distances)]]));
  }

  private drawTarget(): void {
    const { result, drawn } = this.comparisons;
    this.viewer.setTarget(drawn.value ? result.value?.surface : undefined);
  }

  private mark(): void {
    const arrays = this.arrays();
    if (arrays !== undefined) this.viewer.mark(this.following.markers(arrays));
  }
}
