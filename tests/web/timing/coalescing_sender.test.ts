import { expect, test } from "vitest";
import { CoalescingSender } from "../../../web/src/timing/coalescing_sender";
import { FakeClock, settle } from "../fakes/fake_clock";

interface Values {
  force: number;
  length: number;
}

function sender(answer: () => Promise<void> = async () => {}) {
  const sent: Partial<Values>[] = [];
  const clock = new FakeClock();
  const settled: boolean[] = [];
  const send = async (change: Partial<Values>) => {
    sent.push(change);
    await answer();
  };
  const queue: CoalescingSender<Values> = new CoalescingSender(send, clock, () =>
    settled.push(!queue.pending("force")),
  );
  return { sent, clock, queue, settled };
}

test("TheFirstChangeIsSentImmediately", async () => {
  const { sent, queue } = sender();
  queue.push({ force: 1 });
  await settle();
  expect(sent).toEqual([{ force: 1 }]);
});

test("ADragCausesFewCallsAndItsLastValueIsSent", async () => {
  const { sent, clock, queue } = sender();
  // A drag of one second with 100 events per second.
  for (let i = 1; i <= 100; i++) {
    queue.push({ force: i });
    await clock.advance(10);
  }
  await clock.advance(100);
  expect(sent.length).toBeLessThanOrEqual(11);
  expect(sent.at(-1)).toEqual({ force: 100 });
});

test("ChangesOfDifferentValuesAreSentTogether", async () => {
  const { sent, clock, queue } = sender();
  queue.push({ force: 1 });
  queue.push({ force: 2 });
  queue.push({ length: 3 });
  await clock.advance(100);
  expect(sent).toEqual([{ force: 1 }, { force: 2, length: 3 }]);
});

test("OneCallAtATime", async () => {
  let release = () => {};
  const { sent, clock, queue } = sender(() => new Promise((resolve) => (release = resolve)));
  queue.push({ force: 1 });
  queue.push({ force: 2 });
  await clock.advance(1000);
  expect(sent.length).toBe(1);
  release();
  await settle();
  expect(sent).toEqual([{ force: 1 }, { force: 2 }]);
});

test("FlushSendsQueuedChangesDuringACall", async () => {
  const { sent, clock, queue } = sender(() => new Promise(() => {}));
  queue.push({ force: 1 });
  queue.push({ force: 2 });
  queue.flush();
  queue.flush();
  await clock.advance(1000);
  expect(sent).toEqual([{ force: 1 }, { force: 2 }]);
});

test("AValueIsPendingUntilItsCallEnds", async () => {
  const { clock, queue } = sender();
  queue.push({ force: 1 });
  expect([queue.pending("force"), queue.pending("length")]).toEqual([true, false]);
  await clock.advance(100);
  expect(queue.pending("force")).toBe(false);
});

test("OnSettledIsCalledAfterTheCall", async () => {
  const { clock, queue, settled } = sender();
  queue.push({ force: 1 });
  await settle();
  expect(settled).toEqual([]);
  await clock.advance(100);
  expect(settled).toEqual([true]);
});
