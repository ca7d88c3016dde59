export {captureFrame} from "./src/capture.js";
