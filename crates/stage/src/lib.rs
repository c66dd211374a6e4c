//! Renders heads with wgpu: WebGPU, WebGL2 and offscreen.
