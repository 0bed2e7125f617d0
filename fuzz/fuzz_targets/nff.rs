#![no_main]

lightbuffer_fuzz::program!(Nff);
