#![no_main]

lightbuffer_fuzz::program!(Glb);
