//! Friction laws that run on the drive: no_std, allocation-free, the only definition of the law.
