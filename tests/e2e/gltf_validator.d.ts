declare module "gltf-validator" {
  interface Issue {
    code: string;
    message: string;
    /** 0 an error, 1 a warning, 2 information, 3 a hint. */
    severity: number;
    pointer?: string;
  }
  export function validateBytes(bytes: Uint8Array): Promise<{ issues: { messages: Issue[] }; info: object }>;
}
