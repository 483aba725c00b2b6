import { expect, test } from "vitest";
import { UndoHistory } from "../../../web/src/state/undo_history";

test("ADragIsUndoneAsOneChange", () => {
  const changes = new UndoHistory();
  changes.record({ breathForce: 1 }, { breathForce: 1.1 }, 0);
  changes.record({ breathForce: 1.1 }, { breathForce: 1.5 }, 200);
  changes.record({ breathForce: 1.5 }, { breathForce: 3 }, 5000);
  expect(changes.undo()).toEqual({ breathForce: 1.5 });
  expect(changes.undo()).toEqual({ breathForce: 1 });
  expect(changes.undo()).toBeUndefined();
  expect(changes.state.value).toEqual({ undo: false, redo: true });
  expect(changes.redo()).toEqual({ breathForce: 1.5 });
  expect(changes.redo()).toEqual({ breathForce: 3 });
});

test("AChangeAfterUndoClearsRedo", () => {
  const changes = new UndoHistory();
  changes.record({ breathForce: 1 }, { breathForce: 2 }, 0);
  changes.undo();
  changes.record({ elasticity: 1 }, { elasticity: 2 }, 10);
  expect(changes.redo()).toBeUndefined();
  expect(changes.undo()).toEqual({ elasticity: 1 });
});
