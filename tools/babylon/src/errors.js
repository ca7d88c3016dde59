// What a capture says when it cannot be made.
export class CaptureError extends Error {
    constructor(message) {
        super(`glint: ${message}`);
        this.name = "CaptureError";
    }
}

export function require(condition, message) {
    if (!condition) throw new CaptureError(message);
}
