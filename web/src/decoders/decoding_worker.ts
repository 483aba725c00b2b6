import { answerWith } from "./decoding_messages";
import { loadDecoder } from "./load_decoder";

// The script of the worker that decodes frames; WorkerDecoding starts it.
const scope = self as unknown as {
  onmessage: ((event: MessageEvent) => void) | null;
  postMessage(message: unknown, transfer: Transferable[]): void;
};
const answer = answerWith(loadDecoder);
let last = Promise.resolve();
scope.onmessage = ({ data }) => {
  last = last.then(async () => {
    const reply = await answer(data);
    if (reply === undefined) return;
    scope.postMessage(reply, "positions" in reply ? [reply.positions.buffer, reply.poses.buffer] : []);
  });
};
