import { viewpointKeys } from "../viewer/viewpoints";
import type { SceneTools } from "./scene_tools";
import type { Shortcut } from "./shortcuts";

/** Returns the keys of the named views; a scene may lack some. */
export function viewpointShortcuts(tools: SceneTools): Shortcut[] {
  const byKey = (key: string) => tools.viewpoints.value.find((each) => each.key === key);
  return viewpointKeys.map(([key, description]) => ({
    key,
    description,
    when: () => byKey(key) !== undefined,
    run: () => tools.visit(byKey(key)?.name ?? ""),
  }));
}
