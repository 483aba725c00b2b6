import { elementById } from "../dom/elements";
import type { Timeline } from "../panels/view/timeline";
import type { Fluoroscopy } from "./fluoroscopy";
import type { SceneTools } from "./scene_tools";
import { type Shortcut, shortcuts } from "./shortcuts";
import type { StudentView } from "./student_view";
import { viewpointShortcuts } from "./viewpoint_shortcuts";

/** What the keys of the page act on. */
export interface KeyTargets {
  tools: SceneTools;
  student: StudentView;
  fluoroscopy: Fluoroscopy;
  timeline: Timeline;
  toggleGraphs: () => void;
  togglePanel: () => void;
  photograph: () => void;
  share: () => void;
  undo: () => void;
  redo: () => void;
}

/** Returns the dialog that lists the keys of the page, which act from now on. */
export function appShortcuts(targets: KeyTargets): HTMLDialogElement {
  const { tools, student, fluoroscopy, timeline } = targets;
  const press = (id: string) => () => document.getElementById(id)?.click();
  const when = () => student.inLesson;
  const stepForward = () => (timeline.replaying ? timeline.stepFrame(1) : press("step")());
  return shortcuts(
    [
      { key: " ", description: "Play, pause", run: press("play") },
      { key: ".", description: "Step; next frame during replay", run: stepForward },
      { key: ",", description: "Replay, one frame back", run: () => timeline.stepFrame(-1) },
      { key: "r", description: "Reset", run: press("reset") },
      { key: "g", description: "Graphs", run: targets.toggleGraphs },
      { key: "c", description: "Controls", run: targets.togglePanel },
      { key: "b", description: "Compare with healthy", run: press("compare-healthy") },
      { key: "e", description: "Student or expert view", run: () => student.toggle() },
      { key: "PageDown", description: "Next step of the lesson", when, run: () => student.moveInLesson(1) },
      { key: "PageUp", description: "Step before", when, run: () => student.moveInLesson(-1) },
      { key: "h", description: "Whole scene", run: () => tools.visit("home") },
      { key: "f", description: "Front view", run: () => tools.visit("front") },
      ...viewpointShortcuts(tools),
      { key: "/", description: "Find a structure", run: () => elementById("find-structure").focus() },
      { key: "n", description: "Names of structures", run: () => tools.labels.set(!tools.labels.value) },
      { key: "m", description: "Measure a distance", run: () => tools.measuring.start() },
      {
        key: "x",
        description: "Fluoroscopy",
        when: () => !fluoroscopy.button.hidden,
        run: () => void fluoroscopy.toggle(),
      },
      ...escapes(targets),
      { key: "p", description: "Save a screenshot", run: targets.photograph },
      { key: "s", description: "Share, copy, compare", run: targets.share },
    ],
    targets.undo,
    targets.redo,
  );
}

/** What the key Escape ends; the first one that is there. */
function escapes({ tools, fluoroscopy }: KeyTargets): Shortcut[] {
  const { measurements } = tools.measuring;
  return [
    {
      key: "Escape",
      description: "End fluoroscopy",
      when: () => fluoroscopy.isOpen,
      run: () => fluoroscopy.close(),
    },
    {
      key: "Escape",
      description: "End measuring",
      when: () => measurements.tool.value !== undefined,
      run: () => measurements.use(undefined),
    },
    {
      key: "Escape",
      description: "Show all structures again",
      when: () => tools.structures.isolated.value !== undefined,
      run: () => tools.structures.showAll(),
    },
    {
      key: "Escape",
      description: "Remove all measurements",
      when: () => measurements.all.value.length > 0,
      run: () => measurements.clear(),
    },
  ];
}
