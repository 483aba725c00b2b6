import { createGrpcWebTransport } from "@connectrpc/connect-web";
import { type Api, createApi } from "../../web/src/connection/api";

/**
 * The viewer's calls from Node.js, over its fetch. Connect asks for `redirect: "error"`, with which the fetch of
 * Node.js 20 forgets a call's signal once its garbage was collected: a watch that is ended then goes on
 * (https://github.com/nodejs/undici/issues/4627). Chromium's does not.
 */
export function nodeApi(baseUrl: string): Api {
  const followRedirects: typeof fetch = (input, init) => fetch(input, { ...init, redirect: "follow" });
  return createApi(createGrpcWebTransport({ baseUrl, fetch: followRedirects }));
}
