//! What a browser's module computes, to be compared bit by bit with the files of the repository, which the native program
//! computes too. Only tests load it.

mod exertion;
mod orders;
