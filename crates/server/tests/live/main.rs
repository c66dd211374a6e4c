//! The server as a process of its own, on a real socket, in bad circumstances: what it has
//! acknowledged is stored, once, as it was sent.

mod child;
mod disk;
mod faults;
mod fuzz;
mod kill;
mod memory;
mod owner;
mod people;
#[path = "../http/postgres.rs"]
mod postgres;
mod proxy;
#[path = "../http/study.rs"]
#[allow(dead_code)]
mod study;

fn block_on<T>(future: impl Future<Output = T>) -> T {
    tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .unwrap()
        .block_on(future)
}
