import * as THREE from "three";
import { Placement } from "../gen/phrenic/v1/frames_pb";
import { type Body, floatsPerPose, type FrameArrays, positionsOf } from "../geometry/bodies";
import { edgesOf } from "../geometry/edges";
import { computeNormals } from "../geometry/normals";
import type { Simplifier } from "../geometry/simplified";
import { tendonWeights } from "../geometry/tendon";
import { pointMaterial, setDefine, setOpacity, surfaceMaterial } from "./materials";
import { addOverlays, type Overlay, type OverlayHost, type OverlayKind } from "./overlays";
import { ThickLines } from "./thick_lines";
import { tissueOf } from "./tissues";
import { VertexColors, withTemplate } from "./vertex_colors";

/** Opacity of a faded body. */
const fadedOpacity = 0.07;

/**
 * The three.js objects of one body. All objects share one position buffer, so that a frame needs one copy and one
 * upload regardless of the overlays.
 */
export class BodyView implements OverlayHost {
  readonly group = new THREE.Group();
  readonly positions: THREE.BufferAttribute;
  private knownEdges: Uint32Array<ArrayBuffer> | undefined;
  private readonly normals: THREE.BufferAttribute | undefined;
  private readonly mesh: THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial> | undefined;
  private readonly vertexColors: VertexColors | undefined;
  private opacity: number;
  private faded = false;
  private detailed = true;
  private allTriangles: THREE.BufferAttribute | undefined;
  private fewerTriangles: THREE.BufferAttribute | undefined;
  /** Bounding box at rest, in the frame of the body [m]. */
  readonly restBox: THREE.Box3;
  private readonly overlays: Overlay[];
  private readonly thick: ThickLines[] = [];

  /** `diagram` also draws every vertex and edge, for scenes of few vertices. */
  constructor(
    readonly body: Body,
    diagram: boolean,
  ) {
    this.group.name = body.name;
    this.opacity = body.opacity;
    this.positions = new THREE.BufferAttribute(body.rest.slice(), 3);
    this.restBox = new THREE.Box3().setFromArray(body.rest);
    const streamed = body.placement === Placement.STREAMED;
    if (streamed) this.positions.setUsage(THREE.DynamicDrawUsage);
    const solid = body.triangles.length > 0;
    if (solid) {
      this.normals = new THREE.BufferAttribute(new Float32Array(body.rest.length), 3);
      this.mesh = this.addSurface(this.normals);
      const { geometry, material } = this.mesh;
      const tendon = body.rigidLinks.length > 0 ? this.tendonColors() : undefined;
      const own = withTemplate(body.color, body.rest.length / 3, body.template, tendon);
      this.vertexColors = new VertexColors(geometry, material, body.color, own);
    }
    if (!solid || diagram) this.addPointsAndLines(solid ? lighter(body.color) : body.color);
    this.overlays = addOverlays(this);
  }

  /** Pairs of vertex indices; computed on first use, since few bodies show their edges. */
  get edges(): Uint32Array<ArrayBuffer> {
    const { triangles, edges, rest } = this.body;
    this.knownEdges ??= triangles.length > 0 ? edgesOf(triangles, rest.length / 3) : edges;
    return this.knownEdges;
  }

  /** Adds lines that are updated with every frame; only for few lines. */
  addThickLines(lines: ThickLines): void {
    this.thick.push(lines);
    this.group.add(lines.object);
  }

  /** Returns a geometry over this body's vertices; `index` selects some of them. */
  geometry(index?: Uint32Array<ArrayBuffer>): THREE.BufferGeometry {
    const geometry = new THREE.BufferGeometry().setAttribute("position", this.positions);
    if (index !== undefined) geometry.setIndex(new THREE.BufferAttribute(index, 1));
    return geometry;
  }

  private addSurface(normals: THREE.BufferAttribute): THREE.Mesh<THREE.BufferGeometry, THREE.MeshStandardMaterial> {
    const { body } = this;
    computeNormals(body.rest, body.triangles, normals.array as Float32Array);
    const geometry = this.geometry(body.triangles).setAttribute("normal", normals);
    const moving = body.placement === Placement.STREAMED;
    if (moving) geometry.setAttribute("rest", new THREE.BufferAttribute(body.rest, 3));
    const material = surfaceMaterial(body.color, body.opacity, tissueOf(body), moving, middleOf(this.restBox));
    const mesh = new THREE.Mesh(geometry, material);
    mesh.castShadow = body.opacity === 1;
    mesh.receiveShadow = true;
    mesh.frustumCulled = false;
    this.group.add(mesh);
    return mesh;
  }

  private tendonColors(): THREE.BufferAttribute {
    const { body } = this;
    const muscle = new THREE.Color(body.color);
    const tendon = muscle.clone().lerp(new THREE.Color("#f6e3d2"), 0.62);
    const weights = tendonWeights(body.rigidLinks, this.edges, body.rest.length / 3);
    const colors = new Float32Array(body.rest.length);
    const color = new THREE.Color();
    weights.forEach((weight, i) => color.lerpColors(muscle, tendon, weight).toArray(colors, 3 * i));
    return new THREE.BufferAttribute(colors, 3);
  }

  private addPointsAndLines(color: string): void {
    const many = this.edges.length > 2000;
    this.addThickLines(new ThickLines(this.edges, this.positions, color, many ? 1.5 : 3));
    const points = new THREE.Points(this.geometry(), pointMaterial(color, many ? 4 : 10));
    points.frustumCulled = false;
    this.group.add(points);
  }

  /** Moves the body to its state in a frame. */
  update(frame: FrameArrays): void {
    if (this.body.placement === Placement.RIGID) this.pose(frame);
    if (this.body.placement !== Placement.STREAMED) return;
    const now = positionsOf(this.body, frame);
    this.positions.copyArray(now);
    this.positions.needsUpdate = true;
    for (const lines of this.thick) lines.update();
    if (this.normals === undefined) return;
    computeNormals(now, this.body.triangles, this.normals.array as Float32Array);
    this.normals.needsUpdate = true;
  }

  /** Returns the current positions, x y z per vertex [m]. */
  worldPositions(): ArrayLike<number> {
    if (this.body.placement !== Placement.RIGID) return this.positions.array;
    this.group.updateMatrixWorld();
    return this.positions.clone().applyMatrix4(this.group.matrixWorld).array;
  }

  private pose(frame: FrameArrays): void {
    const at = floatsPerPose * this.body.pose;
    this.group.quaternion.fromArray(frame.poses, at);
    this.group.position.fromArray(frame.poses, at + 4);
  }

  /** Sets the opacity, 0 to 1; 0 hides the body. */
  setOpacity(opacity: number): void {
    this.opacity = opacity;
    this.group.visible = opacity > 0;
    if (this.mesh === undefined) return;
    // Field colours are opaque, since their scale could not be read through a transparent surface.
    const shown = this.vertexColors?.active ? 1 : opacity;
    setOpacity(this.mesh.material, this.faded ? Math.min(shown, fadedOpacity) : shown);
    this.mesh.material.forceSinglePass = this.faded;
    this.mesh.castShadow = opacity === 1 && !this.faded;
  }

  /** True if the body is faded. */
  get isFaded(): boolean {
    return this.faded;
  }

  /** Fades the body to an outline, so that another one is seen through it. */
  setFaded(faded: boolean): void {
    this.faded = faded;
    this.setOpacity(this.opacity);
  }

  /** Greys all but some vertices; undefined for none. */
  setRegion(vertices: number[] | undefined): void {
    if (vertices === undefined) return void this.mesh?.geometry.deleteAttribute("apart");
    const apart = new Uint8Array(this.body.rest.length / 3).fill(255);
    for (const vertex of vertices) apart[vertex] = 0;
    this.mesh?.geometry.setAttribute("apart", new THREE.BufferAttribute(apart, 1, true));
  }

  /** Sets how much each vertex is covered by surfaces nearby, 0 to 255. */
  setOcclusion(covered: Uint8Array<ArrayBuffer>): void {
    this.mesh?.geometry.setAttribute("occlusion", new THREE.BufferAttribute(covered, 1, true));
  }

  /**
   * Lights each pixel; or, for machines where the processor draws, each vertex of fewer triangles if they are known.
   */
  setDetailed(detailed: boolean): void {
    if (this.mesh === undefined) return;
    this.detailed = detailed;
    setDefine(this.mesh.material, "DETAILED", detailed);
    this.allTriangles ??= this.mesh.geometry.index!;
    this.mesh.geometry.setIndex(detailed ? this.allTriangles : (this.fewerTriangles ?? this.allTriangles));
  }

  /** Computes the triangles for `setDetailed(false)`, if they are not known yet. */
  async simplify({ simplified }: Simplifier): Promise<void> {
    if (this.mesh === undefined || this.fewerTriangles !== undefined) return;
    this.fewerTriangles = new THREE.BufferAttribute(await simplified(this.body.rest, this.body.triangles), 1);
    this.setDetailed(this.detailed);
  }

  /** Sets whether a plane clips the scene, so that the inside of closed bodies is seen. */
  setCut(cut: boolean): void {
    const solid = this.body.opacity === 1 || this.body.opacity === 0; // what is hidden at first is opaque once shown
    const closed = solid && tissueOf(this.body).section !== undefined;
    if (this.mesh !== undefined && closed) setDefine(this.mesh.material, "SECTION", cut);
  }

  /** Sets vertex colours, three sRGB bytes per vertex; undefined restores the body's own colours. */
  setColors(rgb: Uint8Array | undefined): void {
    this.vertexColors?.set(rgb);
    this.setOpacity(this.opacity);
  }

  /** Shows or hides an overlay. */
  setOverlay(kind: OverlayKind, on: boolean): void {
    for (const overlay of this.overlays) if (overlay.kind === kind) overlay.show(on);
  }

  /** Releases GPU resources. */
  dispose(): void {
    this.group.traverse((object) => {
      if (object instanceof THREE.Mesh || object instanceof THREE.Line || object instanceof THREE.Points) {
        object.geometry.dispose();
        object.material.dispose();
      }
    });
  }
}

function middleOf({ min, max }: THREE.Box3): THREE.Vector2 {
  return new THREE.Vector2((min.x + max.x) / 2, (min.y + max.y) / 2);
}

function lighter(color: string): string {
  return `#${new THREE.Color(color).lerp(new THREE.Color("white"), 0.35).getHexString()}`;
}
