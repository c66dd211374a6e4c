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
mod proxy;
