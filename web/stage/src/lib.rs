//! The canvas module: heads in the browser, built once for WebGPU and once for WebGL2.
