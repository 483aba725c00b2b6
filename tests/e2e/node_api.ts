import { createGrpcWebTransport } from "@connectrpc/connect-web";
import { type Api, createApi } from "../../web/src/connection/api";

/**
 * Creates the viewer's API client in Node.js. Connect sets `redirect: "error"`, and the fetch of Node.js 20 then loses
 * the abort signal of a call after garbage collection, so that an aborted stream continues
 * (https://github.com/nodejs/undici/issues/4627). Chromium is not affected.
 */
export function nodeApi(baseUrl: string): Api {
  const followRedirects: typeof fetch = (input, init) => fetch(input, { ...init, redirect: "follow" });
  return createApi(createGrpcWebTransport({ baseUrl, fetch: followRedirects }));
}
