//! What a frame leaves behind: nothing. Frames run for hours in a study.
#![allow(unsafe_code)] // An allocator is unsafe by its interface.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use mimique_stage::wgpu;
use mimique_stage::{Look, Renderer, View};
use mimique_test_support::skip;

use crate::support;

/// Counts the bytes of the heap that each thread has in use: other tests may run in the same process.
struct Counting;

thread_local! {
    static IN_USE: Cell<isize> = const { Cell::new(0) };
}

impl Counting {
    fn add(bytes: isize) {
        IN_USE.with(|in_use| in_use.set(in_use.get() + bytes));
    }
}

// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::add(layout.size() as isize);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        Self::add(-(layout.size() as isize));
        unsafe { System.dealloc(at, layout) }
    }
}

#[global_allocator]
static HEAP: Counting = Counting;

/// Frames drawn in one go. Each number doubles all frames before it, so that a list that grows by
/// something a frame must grow in each of them, even one that doubles its room.
const FRAMES: [usize; 4] = [100, 200, 400, 800];

#[test]
fn a_thousand_frames_leave_nothing_behind() {
    let test = "a_thousand_frames_leave_nothing_behind";
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let options =
        wgpu::RequestAdapterOptions { force_fallback_adapter: true, ..Default::default() };
    let adapter = match pollster::block_on(instance.request_adapter(&options)) {
        Ok(adapter) => adapter,
        Err(error) => return skip(test, &error.to_string()),
    };
    let limits = wgpu::Limits::downlevel_webgl2_defaults().using_resolution(adapter.limits());
    let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
    let (device, queue) =
        pollster::block_on(adapter.request_device(&descriptor)).expect("a device as a browser's");
    let (format, size) = (wgpu::TextureFormat::Rgba8UnormSrgb, [64, 80]);
    let renderer = Renderer::new(&device, &queue, format, size, Look::STIMULUS);
    let head = renderer.load(&support::egg()).expect("the egg loads");
    let target = device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: 64, height: 80, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    let view = target.create_view(&wgpu::TextureViewDescriptor::default());
    let frames = |count: usize| {
        for frame in 0..count {
            let w = (frame % 100) as f32 / 100.0;
            renderer.render(&view, &head, View::FRONT, &[w, 1.0 - w, w]);
            device.poll(wgpu::PollType::wait_indefinitely()).expect("the frame is drawn");
        }
        let report = instance.generate_report().expect("a native instance");
        let hub = report.hub_report();
        let kept = [&hub.buffers, &hub.textures, &hub.texture_views, &hub.bind_groups]
            .map(|kind| kind.num_allocated);
        (kept, IN_USE.get())
    };
    // Pools of the first frames grow to their size.
    let (kept, mut in_use) = frames(100);
    let growth = FRAMES.map(|count| {
        let (kept_after, in_use_after) = frames(count);
        assert_eq!(kept_after, kept, "buffers, textures, views, groups");
        let growth = in_use_after - in_use;
        in_use = in_use_after;
        growth
    });
    // What a frame leaves behind is there after every number of frames. A pool may still grow once,
    // when the driver is late and a second encoder is needed.
    assert!(
        growth.iter().zip(FRAMES).any(|(&bytes, count)| bytes < count as isize),
        "bytes more after each of {FRAMES:?} frames: {growth:?}"
    );
}
