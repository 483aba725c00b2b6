import { elementById } from "../dom/elements";
import type { Timeline } from "../panels/view/timeline";
import type { Fluoroscopy } from "./fluoroscopy";
import type { SceneTools } from "./scene_tools";
import type { Shortcut } from "./shortcuts";
import type { StudentView } from "./student_view";
import { viewpointShortcuts } from "./viewpoint_shortcuts";

/** What the keys of the page act on. */
export interface ShortcutActions {
  graphs(): void;
  panel(): void;
  photograph(): void;
  share(): void;
  stepForward(): void;
  page: { timeline: Timeline; student: StudentView; tools: SceneTools; fluoroscopy: Fluoroscopy };
}

/** Returns the keys of the page, in the order in which its help lists them. */
export function pageShortcuts(actions: ShortcutActions): Shortcut[] {
  const { graphs, panel, photograph, share, stepForward } = actions;
  const { timeline, student, tools, fluoroscopy } = actions.page;
  const press = (id: string) => () => document.getElementById(id)?.click();
  const when = () => student.inLesson;
  return [
    { key: " ", description: "Play, pause", run: press("play") },
    { key: ".", description: "Step; next frame during replay", run: stepForward },
    { key: ",", description: "Replay, one frame back", run: () => timeline.stepFrame(-1) },
    { key: "r", description: "Reset", run: press("reset") },
    { key: "g", description: "Graphs", run: graphs },
    { key: "c", description: "Controls", run: panel },
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
    {
      key: "Escape",
      description: "End fluoroscopy",
      when: () => fluoroscopy.isOpen,
      run: () => fluoroscopy.close(),
    },
    {
      key: "Escape",
      description: "End measuring",
      when: () => tools.measuring.measurements.tool.value !== undefined,
      run: () => tools.measuring.measurements.use(undefined),
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
      when: () => tools.measuring.measurements.all.value.length > 0,
      run: () => tools.measuring.measurements.clear(),
    },
    { key: "p", description: "Save a screenshot", run: photograph },
    { key: "s", description: "Share, copy, compare", run: share },
  ];
}
